//! Coatings against reflection: the designs that lens makers use, and any list of films.
//!
//! Films have the same index at every wavelength. A design is quarter waves of [`DESIGN_NM`]; those on which glass it
//! is best are said beside it, and on any other it is what it is there.

use serde::Deserialize;
use serde::de::{self, Deserializer, SeqAccess, Visitor};

use super::thin_film::Layer;

/// The wavelength of which the designs are quarter waves, in nm.
pub const DESIGN_NM: f64 = 550.0;

/// The most films that a stack may have.
const MOST_LAYERS: usize = 100;

/// What lies on a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Coating {
    /// Bare glass: Fresnel's reflection, some 4 % between air and crown.
    #[default]
    None,
    /// A quarter wave of magnesium fluoride (n = 1.38): some 1.3 % on crown, the single coating of the 1940s and after.
    MgF2,
    /// Two quarter waves, 1.38 outside and 1.70 inside: nothing is reflected at 550 nm by a glass of 1.70²/1.38² = 1.518,
    /// and much to both sides of it, so that its curve is a V.
    V,
    /// Quarter, half and quarter wave of 1.38, 2.15 and 1.70: two minima, a W, and low in the whole visible range.
    W,
    /// Seven films, as on lenses since the 1980s: under half a per cent from 420 to 680 nm on glasses from 1.5 to 1.8.
    Multi,
    /// Films by hand, from the air to the glass; between two glasses from the front.
    Layers(Vec<Layer>),
}

impl Coating {
    /// The names that [`Coating::named`] knows.
    pub const NAMES: [&str; 5] = ["none", "mgf2", "v", "w", "multi"];

    /// The coating of this name, in capitals or not.
    pub fn named(name: &str) -> Option<Self> {
        let number = Self::NAMES.iter().position(|known| known.eq_ignore_ascii_case(name.trim()))?;
        Some([Self::None, Self::MgF2, Self::V, Self::W, Self::Multi][number].clone())
    }

    /// Its name; `layers` where it is a list.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::MgF2 => "mgf2",
            Self::V => "v",
            Self::W => "w",
            Self::Multi => "multi",
            Self::Layers(_) => "layers",
        }
    }

    /// Its films, from the air to the glass.
    pub fn layers(&self) -> Vec<Layer> {
        let films = |films: &[(f64, f64)]| films.iter().map(|&(index, waves)| Layer::waves(index, waves)).collect();
        match self {
            Self::None => Vec::new(),
            Self::MgF2 => films(&[(1.38, 0.25)]),
            Self::V => films(&[(1.38, 0.25), (1.7, 0.25)]),
            Self::W => films(&[(1.38, 0.25), (2.15, 0.5), (1.7, 0.25)]),
            Self::Multi => films(&MULTI),
            Self::Layers(layers) => layers.clone(),
        }
    }

    /// Why it cannot be used, if it cannot.
    pub(super) fn fault(&self) -> Option<String> {
        let Self::Layers(layers) = self else { return None };
        if layers.len() > MOST_LAYERS {
            return Some(format!("a coating of {} films; {MOST_LAYERS} are the most", layers.len()));
        }
        layers.iter().find_map(Layer::fault)
    }
}

/// Index and optical thickness, in waves of [`DESIGN_NM`], of the films of [`Coating::Multi`], from the air: magnesium
/// fluoride outside, then titania and silica. The thicknesses are those of the least mean fourth power of the reflectance
/// from 420 to 680 nm on glasses of 1.5, 1.6, 1.7 and 1.8 at once.
const MULTI: [(f64, f64); 7] =
    [(1.38, 0.2271), (2.3, 0.4573), (1.46, 0.4958), (2.3, 0.1325), (1.46, 0.0955), (2.3, 0.1058), (1.46, 0.5)];

impl Layer {
    /// A film of an optical thickness in waves of [`DESIGN_NM`].
    pub fn waves(index: f64, waves: f64) -> Self {
        Self { index, thickness_nm: waves * DESIGN_NM / index }
    }

    fn fault(&self) -> Option<String> {
        let Self { index, thickness_nm } = *self;
        if !(index.is_finite() && index >= 1.0) {
            return Some(format!("a film's index of {index} is not 1 or more"));
        }
        // A wave of no film is beyond some micrometres, and rounding would be all that is left of its phase.
        let possible = (0.0..=1e5).contains(&thickness_nm);
        (!possible).then(|| format!("a film of {thickness_nm} nm is not from 0 to 100000 nm thick"))
    }
}

/// A film as it is written: with a thickness, or an optical one in waves.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LayerTable {
    index: f64,
    thickness_nm: Option<f64>,
    waves: Option<f64>,
}

impl<'de> Deserialize<'de> for Layer {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let LayerTable { index, thickness_nm, waves } = LayerTable::deserialize(deserializer)?;
        match (thickness_nm, waves) {
            (Some(thickness_nm), None) => Ok(Self { index, thickness_nm }),
            (None, Some(waves)) => Ok(Self::waves(index, waves)),
            _ => Err(de::Error::custom("a film has either a thickness_nm, or waves of 550 nm")),
        }
    }
}

impl<'de> Deserialize<'de> for Coating {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrLayers;

        impl<'de> Visitor<'de> for NameOrLayers {
            type Value = Coating;

            fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
                write!(formatter, "one of {}, or a list of films", Coating::NAMES.join(", "))
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<Coating, E> {
                Coating::named(name).ok_or_else(|| de::Error::invalid_value(de::Unexpected::Str(name), &self))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut films: A) -> Result<Coating, A::Error> {
                let mut layers = Vec::new();
                while let Some(layer) = films.next_element()? {
                    layers.push(layer);
                }
                Ok(Coating::Layers(layers))
            }
        }

        deserializer.deserialize_any(NameOrLayers)
    }
}

#[cfg(test)]
mod tests {
    use super::super::thin_film::response;
    use super::*;

    fn reflectance(coating: &Coating, glass: f64, wavelength: f64) -> f64 {
        response(1.0, &coating.layers(), glass, wavelength, 1.0).reflectance.mean()
    }

    #[test]
    fn a_v_coat_has_the_closed_form_of_two_quarter_waves() {
        for glass in [1.52, 1.75] {
            let (outer, inner) = (1.38_f64 * 1.38, 1.7_f64 * 1.7);
            let amplitude = (inner - glass * outer) / (inner + glass * outer);
            assert!((reflectance(&Coating::V, glass, DESIGN_NM) - amplitude * amplitude).abs() < 1e-14);
        }
        assert!(reflectance(&Coating::V, 1.7_f64.powi(2) / 1.38_f64.powi(2), DESIGN_NM) < 1e-30);
    }

    #[test]
    fn each_design_reflects_less_than_the_one_before() {
        let mean = |coating: &Coating, glass: f64| {
            (0..27).map(|k| reflectance(coating, glass, 420.0 + 10.0 * f64::from(k))).sum::<f64>() / 27.0
        };
        for glass in [1.52, 1.6] {
            let [none, mgf2, w, multi] =
                [Coating::None, Coating::MgF2, Coating::W, Coating::Multi].map(|coating| mean(&coating, glass));
            assert!(none > 2.0 * mgf2 && mgf2 > 2.0 * w && w > multi, "{glass}: {none} {mgf2} {w} {multi}");
        }
        // A V is the best where it is meant, and worse than a single film away from there.
        assert!(reflectance(&Coating::V, 1.52, 550.0) < 1e-5 && reflectance(&Coating::V, 1.52, 420.0) > 0.015);
    }

    #[test]
    fn a_multilayer_stays_under_half_a_per_cent() {
        for glass in [1.5, 1.6, 1.7, 1.8] {
            for nanometres in (420..=680).step_by(5) {
                let found = reflectance(&Coating::Multi, glass, f64::from(nanometres));
                assert!(found < 0.005, "{glass}, {nanometres} nm: {found}");
            }
        }
    }

    #[test]
    fn a_coating_is_read_by_name_or_film_by_film() {
        #[derive(Debug, Deserialize)]
        struct Holder {
            coating: Coating,
        }
        let read = |text: &str| toml::from_str::<Holder>(text).map(|holder| holder.coating);
        for name in Coating::NAMES {
            assert_eq!(read(&format!("coating = '{name}'")).unwrap().name(), name);
        }
        let films = read("coating = [{ index = 1.38, waves = 0.25 }, { index = 2.0, thickness_nm = 10 }]").unwrap();
        let Coating::Layers(layers) = films else { panic!("{films:?}") };
        assert_eq!(
            layers,
            [Layer { index: 1.38, thickness_nm: 550.0 / 4.0 / 1.38 }, Layer { index: 2.0, thickness_nm: 10.0 }]
        );
        for (text, reason) in [
            ("coating = 'gold'", "one of none, mgf2"),
            ("coating = [{ index = 1.38 }]", "either a thickness_nm"),
            ("coating = [{ index = 1.38, waves = 1, thickness_nm = 1 }]", "either a thickness_nm"),
            ("coating = [{ index = 1.38, nm = 1 }]", "unknown field"),
            ("coating = 3", "list of films"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }

    #[test]
    fn films_that_cannot_be_are_told() {
        for layer in [(0.5, 10.0), (f64::NAN, 10.0), (1.4, -1.0), (1.4, f64::INFINITY)] {
            let layer = Layer { index: layer.0, thickness_nm: layer.1 };
            assert!(Coating::Layers(vec![layer]).fault().is_some(), "{layer:?}");
        }
        assert!(Coating::Layers(vec![Layer::waves(1.4, 0.25); 101]).fault().is_some());
        assert_eq!(Coating::Multi.fault(), None);
    }
}
