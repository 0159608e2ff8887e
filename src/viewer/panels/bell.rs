//! Which bell a ghost has.

use std::sync::Arc;

use egui::{ComboBox, DragValue, Response, Ui};
use glam::DVec2;

use crate::series::{Bell, Profile, SineGaussian, VonMises};
use crate::viewer::control::item_of;
use crate::viewer::model::Look;

/// What bells there are to choose from in a look.
pub struct Bells {
    period: DVec2,
    profiles: Vec<Arc<Profile>>,
}

/// What a list of bells can be, in words.
pub const SPAN: &str = "one of gaussian, cosine-squared, parabola, paraboloid; von-mises or sine-gaussian, which are \
                        periodic and set the period by hand; or a profile of the look's file";

/// What the mean of a sine-Gaussian is, in words.
pub const MEAN: &str = "μ is the sine at which a sine-gaussian is brightest, −1 to 1";

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
        let named = plain.into_iter().chain(periodic).map(|bell| (bell.to_string(), bell));
        let profiles = self.profiles.iter().enumerate();
        let profiles = profiles.map(|(k, profile)| (format!("profile {}", k + 1), Bell::Profile(profile.clone())));
        named.chain(profiles).collect()
    }

    /// A list that opens, and the mean of a bell that has one; a change is one of `bell`.
    pub fn show(&self, ui: &mut Ui, salt: impl std::hash::Hash + std::fmt::Debug, bell: &mut Bell) -> Response {
        let all = self.all();
        let same = |other: &Bell| match (other, &*bell) {
            (Bell::Profile(a), Bell::Profile(b)) => a == b,
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
        response
    }
}
