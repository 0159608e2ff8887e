//! Frames of the window: a slider and a light that are dragged, and a window that rests.

use std::path::Path;
use std::rc::Rc;

use glam::DVec2;

use vglare::Result;
use vglare::gpu::Device;
use vglare::laboratory::bench::{Report, Table, Target};
use vglare::look::{Look, LookLens, LookLights};
use vglare::measure::Samples;
use vglare::photo::Photo;
use vglare::scene::{LensGhost, Light};
use vglare::series::Bell;
use vglare::viewer::replay::{Outcome, Place, Player, Step};
use vglare::viewer::{Document, Times, Timings};

/// Frames of a drag.
const FRAMES: usize = 60;
/// Ghosts of the light that is dragged.
const GHOSTS: usize = 1000;
/// Frames a second that half of a drag's frames must reach.
const STRENGTH_BAR: f64 = 15.0;
const LIGHT_BAR: f64 = 8.0;

/// Drags and rests, with a photo and a screen of the same size.
pub(super) fn window(device: &Rc<Device>, size: [u32; 2], report: &mut Report) -> Result<()> {
    let mut table = Table::new("Frames of the window", "second").note(format!(
        "{FRAMES} frames of each drag, the device's work included; \"most\" is the worst. Indented: what they are made of."
    ));
    let slider = |part| Place::Control("Strength".into(), part);
    let strength = Step::Drag { from: slider(0.3), to: slider(0.9), frames: FRAMES };
    let light = Step::Drag { from: Place::Light(0), to: Place::Picture([0.4, -0.3]), frames: FRAMES };
    let arms = [
        ("strength drag".to_owned(), Look { lights: LookLights::Found, ..Look::default() }, strength, STRENGTH_BAR),
        (format!("drag of a light with {GHOSTS} ghosts"), many_ghosts(), light, LIGHT_BAR),
    ];
    for (name, look, step, bar) in arms {
        let mut player = open(device, size, look)?;
        let outcome = player.step(&step)?;
        table.row(name.clone(), &outcome.frames_ms.iter().copied().collect(), None);
        stages(&mut table, player.app().timings());
        let median = outcome.frames_ms.iter().copied().collect::<Samples>().median();
        report.bar(format!("{name}, frames a second"), Target::AtLeast(bar), 1e3 / median);
        let rested = player.step(&Step::Rest)?;
        let idle = player.step(&Step::Idle(FRAMES))?;
        table.row(format!("idle after the {name}"), &idle.frames_ms.iter().copied().collect(), None);
        let work = |outcome: &Outcome| {
            let counts = outcome.status.counts;
            counts.uploads + counts.spectra + counts.composites + counts.views
        };
        let done = work(&idle) - work(&rested);
        report.bar(format!("{name}, work of {FRAMES} idle frames"), Target::AtMost(0.0), done as f64);
    }
    report.table(table);
    Ok(())
}

/// A player at rest with a synthetic photo.
fn open(device: &Rc<Device>, size: [u32; 2], look: Look) -> Result<Player> {
    let mut player = Player::new(device, look.clone(), size)?;
    player.app().add(Document::new(Path::new("bench.exr"), photo(size), look));
    player.step(&Step::Rest)?;
    // The first change of a kind compiles its shaders.
    player.step(&Step::Key { key: "B".into(), ctrl: false, shift: false })?;
    player.step(&Step::Key { key: "B".into(), ctrl: false, shift: false })?;
    player.step(&Step::Rest)?;
    Ok(player)
}

/// A dark slope with a lamp.
fn photo([width, height]: [u32; 2]) -> Photo {
    let pixel = |i: u32, j: u32| {
        let lit = i.abs_diff(width / 4) < height / 60 && j.abs_diff(height / 4) < height / 60;
        let light = if lit { 300.0 } else { 0.02 + 0.2 * i as f32 / width as f32 };
        [light, 0.9 * light, 0.7 * light, 1.0]
    };
    Photo::new(width, height, (0..height).flat_map(|j| (0..width).map(move |i| pixel(i, j))).collect())
}

/// One light through a lens with [`GHOSTS`] ghosts.
fn many_ghosts() -> Look {
    let ghost = |k: usize| {
        let part = k as f64 / GHOSTS as f64;
        LensGhost {
            bell: Bell::Gaussian,
            along: 3.0 * part - 1.5,
            size: DVec2::splat(0.1 + 0.4 * (7.3 * part).fract()),
            tint: [1.0, 0.5 + 0.5 * part, 1.0 - 0.5 * part],
            share: 0.1 / GHOSTS as f64,
        }
    };
    let light = Light { position: DVec2::new(-0.5, 0.4), flux: [3.0, 2.7, 2.1], size: 0.01, muted: false };
    Look {
        lens: LookLens::Own((0..GHOSTS).map(ghost).collect()),
        lights: LookLights::Listed(vec![light].into()),
        ..Look::default()
    }
}

/// A kind of work, and its time.
type Stage = (&'static str, fn(&Times) -> f64);

/// The times of the work of which a drag's frames are made; the rest of a frame is the panels'.
fn stages(table: &mut Table, timings: &Timings) {
    let all: [Stage; 4] = [
        ("plan", |times| times.plan),
        ("spectrum", |times| times.spectrum),
        ("field and composite", |times| times.composite),
        ("view", |times| times.view),
    ];
    let skipped = timings.pictures().len().saturating_sub(FRAMES);
    for (name, time) in all {
        table.row(format!("  {name}"), &timings.pictures().skip(skipped).map(time).collect(), None);
    }
}
