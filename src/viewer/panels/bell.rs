//! Which bell a ghost has.

use std::sync::Arc;

use egui::{ComboBox, DragValue, Response, Ui};
use glam::DVec2;

use crate::series::{Bell, Disc, Iris, MOST_BLADES, Profile, SineGaussian, VonMises};
use crate::viewer::control::item_of;
use crate::viewer::model::Look;

/// What bells there are to choose from in a look.
pub struct Bells {
    period: DVec2,
    profiles: Vec<Arc<Profile>>,
}

/// What a list of bells can be, in words.
pub const SPAN: &str = "one of gaussian, cosine-squared, parabola, paraboloid; von-mises or sine-gaussian, which are \
                        periodic and set the period by hand; a disc or an iris; or a profile of the look's file";

/// What the parameters of a sine-Gaussian, a disc and an iris are, in words.
pub const PARAMETERS: &str = "μ is the sine at which a sine-gaussian is brightest, −1 to 1; of a disc, how wide the rim is in \
                              sizes, 0 to 2, and of an iris the edge, 0.01 to 0.3; how many blades shape it, 0 where it \
                              is round, and how they are turned";

impl Bells {
    /// Those of a look: periodic ones with its period, and the profiles that its ghosts have.
    pub fn of(look: &Look) -> Self {
        let bells =
            look.lens.ghosts().iter().map(|ghost| &ghost.bell).chain(look.ghosts.iter().map(|ghost| &ghost.bell));
        let mut profiles: Vec<Arc<Profile>> = Vec::new();
        for bell in bells {
            if let Bell::Profile(profile) = bell
                && !profiles.contains(profile)
            {
                profiles.push(profile.clone());
            }
        }
        Self { period: look.bell_period(), profiles }
    }

    /// Every one of them with its name.
    fn all(&self) -> Vec<(String, Bell)> {
        let period = self.period;
        let mean = 0.0;
        let plain = [Bell::Gaussian, Bell::CosineSquared, Bell::Parabola, Bell::Paraboloid];
        let periodic = [Bell::VonMises(VonMises { period }), Bell::SineGaussian(SineGaussian { period, mean })];
        let disc = disc(RIM, 0, 0.0).map(Bell::Disc);
        let iris = iris(EDGE, 6, 0.0).map(Bell::Iris);
        let named = plain.into_iter().chain(periodic).chain(disc).chain(iris).map(|bell| (bell.to_string(), bell));
        let profiles = self.profiles.iter().enumerate();
        let profiles = profiles.map(|(k, profile)| (format!("profile {}", k + 1), Bell::Profile(profile.clone())));
        named.chain(profiles).collect()
    }

    /// A list that opens, and the parameters of a bell that has some; a change is one of `bell`.
    pub fn show(&self, ui: &mut Ui, salt: impl std::hash::Hash + std::fmt::Debug, bell: &mut Bell) -> Response {
        let all = self.all();
        let same = |other: &Bell| match (other, &*bell) {
            (Bell::Profile(a), Bell::Profile(b)) => a == b,
            (Bell::Disc(_), Bell::Disc(_)) => true,
            (Bell::Iris(_), Bell::Iris(_)) => true,
            (a, b) => a.kind() == b.kind(),
        };
        let now = all.iter().position(|(_, other)| same(other));
        let text = now.map_or_else(|| bell.to_string(), |at| all[at].0.clone());
        let mut chosen = None;
        let list = ComboBox::from_id_salt(salt).selected_text(text).show_ui(ui, |ui| {
            for (index, (name, _)) in all.iter().enumerate() {
                let item = |ui: &mut Ui| ui.selectable_label(now == Some(index), name);
                if item_of(ui, name, "Takes this bell", item) && now != Some(index) {
                    chosen = Some(index);
                }
            }
        });
        let mut response = list.response;
        if let Some(index) = chosen {
            *bell = all[index].1.clone();
        }
        if let Bell::SineGaussian(SineGaussian { mean, .. }) = bell {
            let before = *mean;
            response |= ui.add(DragValue::new(mean).range(-1.0..=1.0).speed(0.005).max_decimals(6).prefix("μ "));
            if !mean.is_finite() {
                *mean = before;
            }
        }
        match bell {
            Bell::Disc(now) => {
                let (mut width, mut blades, mut rotation) = (now.rim(), now.blades(), now.rotation());
                response |= opening(ui, ("rim ", 0.0..=2.0), (&mut width, &mut blades, &mut rotation));
                *now = disc(width, blades, rotation).unwrap_or_else(|| now.clone());
            }
            Bell::Iris(now) => {
                let (mut width, mut blades, mut rotation) = (now.edge(), now.blades(), now.rotation());
                response |= opening(ui, ("edge ", 0.01..=0.3), (&mut width, &mut blades, &mut rotation));
                *now = iris(width, blades, rotation).unwrap_or_else(|| now.clone());
            }
            _ => {}
        }
        response
    }
}

/// What a disc that was just chosen has for a rim, and an iris for an edge.
const RIM: f64 = 0.1;
const EDGE: f64 = 0.05;

fn disc(rim: f64, blades: u32, rotation: f64) -> Option<Disc> {
    Disc::new(rim, blades, if blades == 0 { 0.0 } else { rotation }).ok()
}

fn iris(edge: f64, blades: u32, rotation: f64) -> Option<Iris> {
    Iris::new(edge, blades, if blades == 0 { 0.0 } else { rotation }).ok()
}

/// How soft an opening is, its blades and, where it has any, their rotation.
fn opening(
    ui: &mut Ui,
    (name, range): (&str, std::ops::RangeInclusive<f64>),
    (width, blades, rotation): (&mut f64, &mut u32, &mut f64),
) -> Response {
    let before = *blades;
    let mut response = ui.add(DragValue::new(width).range(range).speed(0.005).max_decimals(6).prefix(name));
    let counts = DragValue::new(blades).range(0..=MOST_BLADES).speed(0.05).prefix("blades ");
    response |= ui.add(counts);
    // There is nothing between a round one and a triangle: on the way up 1 is three, and on the way down 2 is none.
    if (1..3).contains(blades) {
        *blades = if before == 0 { 3 } else { 0 };
    }
    if *blades > 0 {
        let turn = DragValue::new(rotation).range(-360.0..=360.0).speed(0.5).max_decimals(3).suffix("°");
        response |= ui.add(turn);
    }
    response
}
