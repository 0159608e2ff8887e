//! Veils against a copy of the picture: by the CPU, whose times the copy ties to the frame's, and by the device where it can.

use std::hint::black_box;

use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Arm, Stage};
use crate::chance::Chance;
use crate::choices::Projection;
use crate::job::plan_of;
use crate::look::Veil;
use crate::measure::{Samples, interleave};
use crate::photo::View;
use crate::plan::Evaluator;
use crate::psf::{Name, Parameters};
use crate::renderer::Scatter;
use crate::scene::VeilSection;
use crate::veil::{self, Plan};
use crate::{Error, Result};

/// How far a wide Gaussian's time may be from a narrower one's.
const ALIKE: f64 = 0.1;

/// A veil, its tolerance, and how many copies it may take.
struct Case {
    what: &'static str,
    section: VeilSection,
    tolerance: f64,
    most: f64,
}

/// A Gaussian of a part of the width is `part` times twice the aspect half heights.
fn cases(aspect: f64) -> [Case; 4] {
    let eye = |projection| VeilSection {
        parameters: Parameters { age: Some(60.0), ..Parameters::new(Name::Cie) },
        fov: Some(50.0),
        projection: Some(projection),
        border: None,
        tolerance: None,
    };
    let gaussian = |part: f64| VeilSection {
        parameters: Parameters {
            width: Some(part * 2.0 * aspect),
            scatter: Some(0.1),
            ..Parameters::new(Name::Gaussian)
        },
        fov: None,
        projection: None,
        border: None,
        tolerance: None,
    };
    [
        Case { what: "cie on a plane", section: eye(Projection::Planar), tolerance: 1e-2, most: 10.0 },
        Case { what: "cie, rectilinear", section: eye(Projection::Rectilinear), tolerance: 1e-2, most: 25.0 },
        Case { what: "a Gaussian of 5 % of the width", section: gaussian(0.05), tolerance: 1e-3, most: 4.0 },
        Case { what: "a Gaussian of 20 % of the width", section: gaussian(0.2), tolerance: 1e-3, most: 4.0 },
    ]
}

/// Measures each veil and a copy in turns.
pub(super) fn against_a_copy(stage: &Stage, report: &mut Report) -> Result<()> {
    let frame = stage.frame;
    let size = [frame.width as usize, frame.height as usize];
    let pixels = photo(size);
    let sources = veil::Photo::rgba(pixels.as_flattened(), size).map_err(|error| Error::Plan(error.to_string()))?;
    let mut actor = stage.actor(&scenes::by(Evaluator::Direct, scenes::scattered(1, 0.3, frame), frame, 1e-3)?)?;
    let mut scatter = Scatter::new(stage.shared_device())?;
    let mut table = Table::new("Veils of three colours against a copy", "copy");
    let mut widths: Vec<Samples> = Vec::new();
    for Case { what, section, tolerance, most } in cases(f64::from(frame.width) / f64::from(frame.height)) {
        let veil = Veil::new(&section, false).map_err(|fault| Error::Plan(fault.to_string()))?;
        let view = section.fov.map(|fov| View::of_field(fov, &frame, veil.projection()));
        let plan = plan_of(&veil, &frame, view.as_ref(), tolerance)?;
        let mut evaluate = || evaluated(&plan, &sources);
        let by_device = scatter.check(&plan).is_ok();
        let mut summed = || scatter.evaluate(&plan, &sources).map(|veil| drop(black_box(veil)));
        let (copy, took, device) = if by_device {
            let arms = [&mut || actor.copy(), &mut evaluate, &mut summed] as [Arm<'_>; 3];
            let [copy, took, device] = interleave(stage.rounds, arms)?;
            (copy, took, Some(device))
        } else {
            let [copy, took] = interleave(stage.rounds, [&mut || actor.copy(), &mut evaluate] as [Arm<'_>; 2])?;
            (copy, took, None)
        };
        let ratio = took.over(&copy);
        table.row(format!("copy, for {what}"), &copy, None);
        table.row(format!("{what}, {tolerance:e} asked, {:.1e} predicted", plan.predicted().bound), &took, Some(ratio));
        if let Some(device) = device {
            table.row(format!("{what}, by the device"), &device, Some(device.over(&copy)));
        }
        report.bar(format!("{what}: veil / copy"), Target::AtMost(most), ratio.paired);
        if section.parameters.psf == Name::Gaussian {
            widths.push(took);
        }
    }
    report.table(table);
    if let [narrow, wide] = &widths[..] {
        report.bar("a Gaussian of 20 % / of 5 % of the width", Target::Equal(ALIKE), wide.median() / narrow.median());
    }
    Ok(())
}

fn evaluated(plan: &Plan, photo: &veil::Photo<'_>) -> Result<()> {
    black_box(plan.evaluate(photo).map_err(|error| Error::Plan(error.to_string()))?);
    Ok(())
}

/// A dim picture with some bright pixels, the same every time.
pub(super) fn photo([width, height]: [usize; 2]) -> Vec<[f32; 4]> {
    let mut chance = Chance::new(1);
    let mut pixel = |_| {
        let bright = if chance.between(0.0, 1.0) < 1e-4 { 1e4 } else { 1.0 };
        [0, 1, 2, 3].map(|channel| if channel < 3 { (bright * chance.between(0.01, 1.0)) as f32 } else { 1.0 })
    };
    (0..width * height).map(&mut pixel).collect()
}
