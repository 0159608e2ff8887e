//! A veil, summed: by the CPU, or by the device where that costs less.

use super::failed;
use super::planning::Channel;
use crate::choices::Processor;
use crate::job::Computer;
use crate::plan::CostModel;
use crate::veil::{Photo, Veil};
use crate::{Error, Result};

/// What a pixel costs the CPU beside its multiply-adds, in these: its passage up and down the lattices.
const PASSAGE: f64 = 50.0;
/// Channels: the CPU takes one after the other, a device all of them at once.
const CHANNELS: f64 = 3.0;

/// A veil, and how it came about.
pub(super) struct Summed {
    pub veil: Veil,
    pub by: Processor,
    /// What went wrong without keeping the veil from being summed.
    pub note: Option<String>,
}

/// The veil, each channel by its kernel, within a tolerance: by what the computer was told, or by what costs less.
///
/// # Errors
/// Those of [`crate::veil::Plan::evaluate`], and of [`crate::renderer::Scatter::evaluate`] where the device was asked for.
pub(super) fn summed(
    channels: &[Channel],
    sources: &Photo<'_>,
    asked: f64,
    computer: Option<&mut Computer>,
) -> Result<Summed> {
    let by_cpu = |note| Ok(Summed { veil: computed(channels, sources)?, by: Processor::Cpu, note });
    let Some(computer) = computer else { return by_cpu(None) };
    let told = computer.veil_by;
    let software = computer.info.software;
    let by =
        told.unwrap_or_else(|| if software { Processor::Cpu } else { cheaper(channels, asked, &computer.known.model) });
    if by == Processor::Cpu {
        return by_cpu(None);
    }
    match by_device(channels, sources, computer) {
        Ok(veil) => Ok(Summed { veil, by, note: None }),
        Err(error) if told.is_none() => by_cpu(Some(format!("the veil was summed by the CPU: {error}"))),
        Err(error) => Err(error),
    }
}

/// What costs less by a cost model, of what holds the tolerance.
fn cheaper(channels: &[Channel], asked: f64, model: &CostModel) -> Processor {
    let mut more = 0.0;
    for (plan, _) in channels {
        let Some(planned) = plan.on_device().filter(|planned| planned.bound() <= asked) else {
            return Processor::Cpu;
        };
        let (pixels, labour) = (planned.pictures() * planned.pixels(), planned.labour());
        let cpu = CHANNELS * pixels * (plan.predicted().operations + PASSAGE) * model.veil_add;
        let device = labour.taps * model.veil_tap + labour.passes * model.pass + labour.moved * model.veil_pixel;
        more += device - cpu;
    }
    if more < 0.0 { Processor::Gl } else { Processor::Cpu }
}

/// The veil by the CPU.
pub(super) fn computed(channels: &[Channel], sources: &Photo<'_>) -> Result<Veil> {
    joined(channels.iter().map(|(plan, _)| plan.evaluate(sources).map_err(failed)).collect::<Result<_>>()?)
}

fn by_device(channels: &[Channel], sources: &Photo<'_>, computer: &mut Computer) -> Result<Veil> {
    let scatter = computer.scatter()?;
    joined(channels.iter().map(|(plan, _)| scatter.evaluate(plan, sources)).collect::<Result<_>>()?)
}

/// Each channel of its own veil, where there are several.
fn joined(mut all: Vec<Veil>) -> Result<Veil> {
    if all.is_empty() {
        return Err(Error::Plan("a veil has a kernel".into()));
    }
    let mut veil = all.remove(0);
    for (channel, mut other) in (1..).zip(all) {
        veil.planes[channel] = std::mem::take(&mut other.planes[channel]);
        (veil.dark[channel], veil.lonely[channel]) = (other.dark[channel], other.lonely[channel]);
        veil.certified[channel] = other.certified[channel];
    }
    Ok(veil)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::veil::planning::Definition;
    use crate::veil::{Border, Gaussian, Geometry, Kernel, Mixture, Plan};

    const SIZE: [usize; 2] = [320, 180];

    /// Wide enough that the kernel vanishes nowhere on the picture.
    const WIDTHS: [[f64; 2]; 4] = [[2.0, 1.0], [9.0, 0.1], [40.0, 0.01], [200.0, 0.001]];

    fn planned(geometry: Geometry, size: [usize; 2]) -> Channel {
        let terms = WIDTHS.into_iter().map(|[sigma, weight]| Gaussian { sigma, weight }).collect();
        let kernel = Kernel::from_mixture(Mixture { terms, ..Mixture::default() }).expect("a kernel");
        let plan = Plan::new(&geometry, &kernel, size, Border::None, 1e-2).expect("a plan");
        (plan, Definition::Radial(kernel))
    }

    /// A software renderer's constants take the CPU, those of a graphics card the device, where it can.
    #[test]
    fn the_cheaper_is_taken_of_what_can_sum() {
        let flat = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };
        let built_in = CostModel::default();
        let card = CostModel { veil_tap: 0.002, veil_pixel: 0.1, pass: 1.0, ..built_in };
        let channels = [planned(flat, SIZE)];
        assert_eq!(cheaper(&channels, 1e-2, &built_in), Processor::Cpu);
        assert_eq!(cheaper(&channels, 1e-2, &card), Processor::Gl);
        let slow_bus = CostModel { veil_pixel: 100.0, ..card };
        assert_eq!(cheaper(&channels, 1e-2, &slow_bus), Processor::Cpu);
        // The bound of the device has to be within what is asked, too.
        let bound = channels[0].0.on_device().expect("a plan for a device").bound();
        assert_eq!(cheaper(&channels, 0.999 * bound, &card), Processor::Cpu);
        // Of three channels all have to be for a device.
        let sphere = planned(Geometry::rectilinear(40.0, 16), [16, 16]);
        let [one, two] = [0, 1].map(|_| planned(flat, SIZE));
        assert_eq!(cheaper(&[one, two, sphere], 1e-2, &card), Processor::Cpu);
    }
}
