//! A plan in words.

use std::io::{self, Write};

use crate::job::{Planning, VeilPlanned, VeilSeen};
use crate::plan::{Cost, Evaluator, Faint, Gatherer, Gathering, Group, Layer, Plan, Source, Transform, Way};
use crate::raster::Reduction;
use crate::series::moments::{Cells, Grid};

/// Groups that are told one by one.
const GROUPS: usize = 12;

/// The line of the summary.
pub fn plan(out: &mut dyn Write, plan: &Plan) -> io::Result<()> {
    if plan.ghosts() == 0 {
        return Ok(());
    }
    write!(out, "plan     {}", plan.evaluator())?;
    if plan.terms() > 0 {
        let ([n, m], period) = (plan.degree(), plan.period());
        write!(out, ", degree {n} x {m}, {} terms, period {:.2} x {:.2}", plan.terms(), period.x, period.y)?;
    }
    if let Some(local) = plan.local() {
        let pixels = plan.problem().frame().window.pixels() as f64;
        write!(out, ", {:.2} bells at a pixel", local.reached / pixels)?;
    }
    if let Some(plate) = plan.plate().filter(|_| plan.evaluator() != Evaluator::Plate) {
        write!(out, ", and a plate of {} sharp ghosts of every pixel", plate.groups.len())?;
    }
    if let Some(beside) = plan.costs.first().and_then(Cost::beside) {
        write!(out, ", of {} ghosts {beside}", plan.ghosts())?;
    }
    let faint = plan.faint_images().filter(|faint| faint.images > 0);
    if let Some(Faint { images, of, light }) = faint {
        write!(out, ", {images} of {of} images too faint to show, with {:.2} % of their light", 100.0 * light)?;
    }
    match plan.dropped - faint.map_or(0, |faint| faint.images) {
        0 => writeln!(out),
        n => writeln!(out, ", {n} ghosts out of reach"),
    }
}

/// What is planned of a veil, in three lines.
pub fn veil(out: &mut dyn Write, veil: &VeilPlanned) -> io::Result<()> {
    let VeilPlanned { seen, scattered, asked, predicted, rounding, .. } = veil;
    let VeilSeen { parameters, projection, fov, fov_from, border: _ } = seen;
    write!(out, "veil     {}", parameters.psf)?;
    if let Some((fov, from)) = fov.zip(fov_from.as_ref()) {
        write!(out, ", {from}: {} across", angle(fov))?;
    }
    let share = 100.0 * scattered.iter().sum::<f64>() / 3.0;
    let projection = format!("{projection:?}").to_lowercase();
    writeln!(out, ", {projection}: scatters {share:.1} % of the light, by {}", summed(&veil.summed_by, veil.terms))?;
    write!(out, "         ")?;
    if has_gaussians(&veil.summed_by) {
        write!(out, "{} on the pixels", veil.direct)?;
        for (level, count) in (1..).zip(&veil.lattices) {
            write!(out, ", {count} on a lattice of {}", 1u64 << level)?;
        }
        write!(out, ", {} left out", veil.dropped)?;
        if veil.reach > 0.0 {
            write!(out, ", a kernel of {:.1} pixels", veil.reach)?;
        }
        write!(out, "; ")?;
    }
    writeln!(out, "{:.0} operations a pixel and colour", veil.operations)?;
    writeln!(
        out,
        "         error {predicted:.1e} of the local veil, {rounding:.1e} of it rounding, {asked:.1e} asked"
    )?;
    veil.notes.iter().try_for_each(|note| writeln!(out, "note     {note}"))
}

/// Whether Gaussians are summed, and not only what they stand for.
fn has_gaussians(summed_by: &str) -> bool {
    summed_by.contains("pyramid") || summed_by.contains("sphere")
}

/// By what a veil is summed, of a function for which so many Gaussians stand.
pub fn summed(summed_by: &str, terms: usize) -> String {
    let gaussians = if terms == 1 { "1 Gaussian".to_owned() } else { format!("{terms} Gaussians") };
    match summed_by {
        "pyramid" => format!("a pyramid of {gaussians}"),
        "sphere" => format!("{gaussians} on the sphere"),
        "transform" => "a transform".to_owned(),
        "sum" => "a sum of every pixel's light at every other".to_owned(),
        several => format!("{several}, of {gaussians}"),
    }
}

/// An angle to a thousandth of a degree where it is one of these, else to a tenth.
pub fn angle(degrees: f64) -> String {
    let near = (1e3 * degrees).round() / 1e3;
    if (near - degrees).abs() < 1e-9 * degrees { format!("{near}°") } else { format!("{degrees:.1}°") }
}

/// All that there is to say of it: groups, lattice, the bounds of the error line by line, and every candidate.
pub fn details(out: &mut dyn Write, planned: &Planning) -> io::Result<()> {
    let plan = &planned.plan;
    if plan.ghosts() + plan.dropped == 0 {
        return Ok(());
    }
    groups(out, plan)?;
    if let Some(lattice) = &plan.lattice() {
        let ([x, y], over) = (lattice.nodes, lattice.oversampling);
        writeln!(out, "lattice  {x} x {y} nodes, {:.2} x {:.2} to the shortest half wave", over.x, over.y)?;
    }
    errors(out, plan)?;
    candidates(out, plan)?;
    match &planned.calibration {
        Some(file) => writeln!(out, "costs    by what vglare calibrate measured here: {}", file.display()),
        None => {
            writeln!(out, "costs    by the built-in cost model, of two cores; vglare calibrate measures this machine")
        }
    }
}

fn groups(out: &mut dyn Write, plan: &Plan) -> io::Result<()> {
    let all = plan
        .layers()
        .iter()
        .flat_map(|layer| layer.groups().iter().enumerate().map(move |(place, group)| (layer, place, group)));
    for (index, (layer, place, group)) in all.take(GROUPS).enumerate() {
        let label = if index == 0 { "groups" } else { "" };
        let Group { bell, ghosts, smallest, largest, degree: [n, m], .. } = group;
        let more = if largest == smallest { "" } else { " and more" };
        write!(out, "{label:<9}{ghosts} {bell} of {:.3} x {:.3}{more}", smallest.x, smallest.y)?;
        match group.transform {
            Transform::Direct if layer.evaluator() == Evaluator::Local => writeln!(out, ", summed where they reach")?,
            Transform::Direct if let Layer::Plate(plate) = layer => {
                writeln!(out, ", {}", on_plate(plate.parts[place].way))?
            }
            Transform::Direct => writeln!(out, ", summed directly")?,
            Transform::Dispatch => writeln!(out, ", degree {n} x {m}")?,
            Transform::Photo(Reduction { level, points: [x, y], transformed, .. }) => {
                let transform = if transformed { "the transform of " } else { "" };
                write!(out, ", degree {n} x {m}, from {transform}the photo's ")?;
                match level {
                    0 => writeln!(out, "pixels")?,
                    _ => writeln!(out, "moments on {x} x {y} points")?,
                }
            }
            Transform::Gather(Gathering { by, sizes }) => {
                write!(out, ", degree {n} x {m}, gathered ")?;
                match by {
                    Gatherer::Cells(Cells { counts: [x, y], orders: [p, q] }) => {
                        write!(out, "in {x} x {y} cells of {p} x {q} moments")?;
                    }
                    Gatherer::Grid(Grid { nodes: [x, y] }) => write!(out, "by a transform of {x} x {y} nodes")?,
                }
                let sizes = if sizes == 1 { String::new() } else { format!(" for each of {sizes} sizes") };
                writeln!(out, "{sizes}")?;
            }
        }
    }
    match plan.groups().count().saturating_sub(GROUPS) {
        0 => Ok(()),
        more => writeln!(out, "         and {more} groups more"),
    }
}

/// How an image of the photo is summed on a plate.
fn on_plate(way: Way) -> String {
    match way {
        Way::Products => "summed along rows and columns".into(),
        Way::Pairs => "each pixel summed where it reaches".into(),
        Way::Spans => "its flat part summed by spans of rows, its rim by pixels".into(),
        Way::Lattice { finer, alone_above } => {
            let alone = if alone_above.is_finite() { ", but for the brightest pixels" } else { "" };
            format!("on a lattice of {finer} x {finer} points a pixel{alone}")
        }
    }
}

fn errors(out: &mut dyn Write, plan: &Plan) -> io::Result<()> {
    for (index, Source { name, about, error }) in plan.predicted.sources().enumerate() {
        let label = if index == 0 { "bounds" } else { "" };
        writeln!(out, "{label:<9}at most {error:.1e} from {about} ({name})")?;
    }
    writeln!(out, "{:<9}at most {:.1e} in all (total)", "", plan.predicted.total())?;
    writeln!(out, "         {:.1e} is the tolerance", plan.tolerance)
}

/// The evaluators, the chosen one first; of the others, why not.
fn candidates(out: &mut dyn Write, plan: &Plan) -> io::Result<()> {
    let least = plan.cost().unwrap_or(f64::NAN);
    for (index, cost) in plan.costs.iter().enumerate() {
        let name = cost.evaluator.to_string();
        let beside = cost.beside().map_or(String::new(), |beside| format!(", with {beside}"));
        match index {
            0 => writeln!(out, "chosen   {name:<8}{:>10.1} ms expected{beside}", cost.milliseconds)?,
            _ => {
                let (ms, times) = (cost.milliseconds, cost.milliseconds / least);
                writeln!(out, "rejected {name:<8}{ms:>10.1} ms expected{beside}: {times:.1} times as much")?;
            }
        }
    }
    for refusal in &plan.refused {
        let name = refusal.evaluator.to_string();
        writeln!(out, "refused  {name:<8}{}", refusal.reason)?;
    }
    Ok(())
}
