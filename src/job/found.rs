//! The first step: what glares in a photo.

use std::sync::Arc;

use super::beside::beside;
use super::planned::stays_finite;
use super::{
    Computer, Darkest, Done, Planned, Stages, Step, Wanted, Watch, bright_light, panorama, plan, settings, veil,
};
use crate::frame::Frame;
use crate::look::{Gathered, Look, Search};
use crate::photo::{self, BadPixels, Facts, Photo};
use crate::plan::MANY_IMAGES;
use crate::renderer::Settings;
use crate::scene::{FindOptions, Recovered};
use crate::{Result, limits};

/// What planning the ghosts of all pixels takes, and what each pixel adds to that, in bytes.
const SOURCES: u64 = 160 << 20;
const SOURCE: u64 = 32;
/// And what the transform of all pixels adds, which many ghosts share.
const TRANSFORMED: u64 = 96;

/// A photo in which it is known what glares.
pub struct Found<'a> {
    /// What is laid over it.
    pub look: &'a Look,
    /// Someone else may hold it, too; where no one does, the picture takes over its memory.
    pub photo: Arc<Photo>,
    /// Its frame, with lengths in the look's unit.
    pub frame: Frame,
    /// What is told of it.
    pub facts: Facts,
    /// Its pixels that are no light.
    pub bad: BadPixels,
    /// What glares in it.
    pub scene: Gathered,
    /// How long each stage took, from reading on.
    pub stages: Stages,
    /// What a person ought to know.
    pub warnings: Vec<String>,
    /// How its pixels shine.
    pub(super) recovered: Recovered,
    pub(super) settings: Settings,
}

impl<'a> Found<'a> {
    /// Finds what glares in a photo.
    ///
    /// # Errors
    /// Those of [`Look::frame`] and [`settings()`].
    pub fn new(look: &'a Look, photo: impl Into<Arc<Photo>>, stages: Stages) -> Result<Self> {
        Self::knowing(look, photo, None, stages)
    }

    /// The same for a photo that may have been searched already: by the rules of this look it is not searched again.
    ///
    /// # Errors
    /// Those of [`Look::frame`] and [`settings()`].
    pub fn knowing(
        look: &'a Look,
        photo: impl Into<Arc<Photo>>,
        search: Option<Search>,
        mut stages: Stages,
    ) -> Result<Self> {
        let photo = photo.into();
        let frame = look.frame(&photo)?;
        let bad = stages.time("survey", || photo::survey(&photo));
        let recovered = || if look.takes_light() { look.recovered(&photo) } else { Recovered::default() };
        let recovered = stages.time("recover", recovered);
        if look.strength != 0.0 && look.takes_photo() {
            // Their light, its moments, and the waves that a plan looks at.
            let source = SOURCE + if look.lens_ghosts().len() >= MANY_IMAGES { TRANSFORMED } else { 0 };
            limits::room(SOURCES + source * photo.pixels.len() as u64, "planning the ghosts of all pixels")?;
        }
        let scene = stages.time("lights", || look.gather_knowing(&photo, &recovered, &frame, search));
        let mut warnings = photo.source.notes.clone();
        let bright = |threshold| bright_light(&photo, &recovered, &frame, look.find.by, threshold);
        let (settings, warning) = settings(look, &photo, &scene, bright)?;
        warnings.extend(warning);
        let FindOptions { threshold, knee, recover, .. } = look.find;
        let unsaid = [FindOptions::default(), FindOptions::VERSION_1];
        if look.takes_photo()
            && unsaid.iter().all(|rules| look.find != FindOptions { threshold, knee, recover, ..*rules })
        {
            warnings.push(
                "rules for lights, but for a threshold, change nothing where every pixel is a source: --sources lights looks for lights"
                    .into(),
            );
        }
        if knee != 0.0 && !look.finds() && !(look.takes_photo() && threshold.is_some()) {
            warnings.push("a knee is of a threshold, of which there is none here, and changes nothing".into());
        }
        let veil = look.veil_on(&frame);
        if look.strength != 0.0 && look.veil.is_some() && veil.is_none() {
            let why = if frame.pixel_aspect == 1.0 { "glare that is normalised" } else { "pixels that are not square" };
            warnings
                .push(format!("{why} can have no veil: that of the lens is left out, and its ghosts are all there is"));
        }
        if !look.is_panorama() && (veil.is_some() || look.strength != 0.0 && !scene.is_dark()) {
            warnings.extend(panorama::seam(&photo));
        }
        Ok(Self { look, facts: photo.facts(), photo, frame, bad, scene, stages, warnings, recovered, settings })
    }

    /// The same, where glare that is stretched is stretched between these values of the field instead of its own least and largest: so that
    /// frames of a shot have one scale ([`Planned::range`]).
    #[must_use]
    pub fn stretched_by(mut self, range: Option<[f32; 2]>) -> Self {
        self.settings.range = range;
        self
    }

    /// Lays the glare over the photo. A look of strength 0 has none and needs no computer; without a computer there is
    /// none either.
    ///
    /// # Errors
    /// Those of [`Found::plan`] and [`Planned::render`].
    pub fn compute(self, computer: Option<&mut Computer>, wanted: Wanted, watch: &impl Watch) -> Result<Done<'a>> {
        match computer {
            Some(computer) if self.look.renders() => self.plan(computer, watch)?.render(computer, wanted, watch),
            computer => self.without_ghosts(computer, wanted, watch),
        }
    }

    /// Plans how the glare is computed.
    ///
    /// # Errors
    /// Where there is no plan, or its glare is beyond what 32-bit floats hold; [`crate::Error::Cancelled`].
    pub fn plan(mut self, computer: &mut Computer, watch: &impl Watch) -> Result<Planned<'a>> {
        watch.begin(Step::Planning)?;
        let problem = self.scene.problem(self.frame);
        let known = computer.known.clone();
        let (look, photo) = (self.look, &self.photo);
        let planning = self.stages.time("plan", || {
            let darkest = Darkest::new(look, photo, &problem)?;
            plan(&look.accuracy, darkest.as_ref(), &problem, Some(&computer.info), known)
        })?;
        computer.known.warning = None;
        self.warnings.extend(planning.warnings.iter().cloned());
        self.settings.check(planning.plan.scale)?;
        self.warnings.extend(self.absurd(&planning.plan));
        Ok(Planned { found: self, planning, info: computer.info.clone() })
    }

    /// The photo with its veil, where it has one, or as it is, and black glare.
    fn without_ghosts(self, computer: Option<&mut Computer>, wanted: Wanted, watch: &impl Watch) -> Result<Done<'a>> {
        let Self { look, photo, frame, facts, bad, scene, mut stages, mut warnings, recovered, settings: _ } = self;
        let before = if bad.nan + bad.infinite > 0 { photo::not_finite(&photo.pixels) } else { 0 };
        watch.begin(Step::Computing)?;
        let cast = veil::cast(look, &photo, &recovered, &frame, wanted.verify, computer, &mut stages)?;
        let dark = || photo.companion(vec![[0.0, 0.0, 0.0, 1.0]; photo.frame.window.pixels()]);
        let mut glare = wanted.glare.then(dark);
        if let (Some(cast), Some(glare)) = (&cast, &mut glare) {
            cast.add_to(&mut glare.pixels);
        }
        let change = cast.as_ref().map(|cast| cast.change(&photo.pixels));
        let mut picture = wanted.picture.then(|| Arc::unwrap_or_clone(photo));
        if let Some(picture) = picture.as_mut().filter(|_| wanted.layers) {
            picture.source.beside = beside(&scene, None, change.as_ref(), frame.window.pixels());
        }
        if let (Some(change), Some(picture)) = (change, &mut picture) {
            stages.time("composite", || change.add_to(&mut picture.pixels));
        }
        stays_finite(picture.as_ref(), before, glare.as_ref(), cast.as_ref(), 0)?;
        let veiled = cast.map(|cast| cast.veiled);
        warnings.extend(veiled.as_ref().and_then(|veiled| Some(veiled.error.check().err()?.to_string())));
        Ok(Done { look, frame, facts, bad, scene, picture, glare, computed: None, veiled, stages, warnings })
    }
}
