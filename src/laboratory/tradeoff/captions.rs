//! What to see in each plot, for someone who has never seen vglare.

use super::Results;
use super::front::{regret, short};
use super::point::Sweep;
use crate::laboratory::page::pairs;

/// How a size stands in a text.
fn size([width, height]: [u32; 2]) -> String {
    format!("{width} × {height} pixels")
}

pub(super) fn tolerance(results: &Results) -> String {
    let text = format!(
        "Each curve is one way to compute the field (an evaluator), from a coarse tolerance at its upper end to a fine one \
         at its lower; down and left is better. Where no evaluator is named, vglare takes the ringed points. Times are \
         medians of {} rounds in turns at {}; errors are the largest at {} pixels. Where 32-bit floats would not be exact enough \
         the same evaluators compute in 64-bit ones, to which a curve may step; all end where the last digit of the field, which \
         is stored in 32 bits, is rounded, at 6e-8.",
        results.rounds,
        size(results.swept),
        results.sample
    );
    text + parts(results, Sweep::Tolerance)
}

/// What to say of times that were scaled.
fn parts(results: &Results, sweep: Sweep) -> &'static str {
    let scaled = |share: f64| share < 1.0;
    let any = results.points.iter().any(|point| point.sweep == sweep && point.timed_share.is_some_and(scaled));
    match any {
        true => " Where direct or series would take long, some rows of the picture were drawn and their time scaled.",
        false => "",
    }
}

pub(super) fn veil(results: &Results) -> String {
    format!(
        "The veil of every pixel, summed on the processor at {}, without planning, which is done once for a size. Errors are relative \
         to the veil at each pixel, and so are the bounds: in the shadows, too. Times are medians of {} rounds in turns.",
        size(results.swept),
        results.rounds
    )
}

pub(super) fn degree() -> String {
    "How many harmonics are enough: the degree N along x, with M along y in the planned proportion, all N × M modes kept, in \
     the period that is planned for a fine tolerance. The bound assumes that all ghosts are worst at one pixel, so the \
     measured error lies at or below it; both end on a floor that 32-bit floats make, which this sweep keeps to. Marks are the planner’s degrees for these tolerances, by the evaluator that it chooses."
        .to_owned()
}

pub(super) fn oversampling() -> String {
    "grid evaluates the series on a coarse lattice and interpolates. Twice the nodes make the interpolation about sixteen \
     times as exact, until what is left is the series’ own error. In 64-bit floats, where more digits are wanted, the lattice \
     is interpolated by eight nodes along each axis instead of four."
        .to_owned()
}

pub(super) fn storage() -> String {
    "The same plans with the spectrum’s terms rounded to 16-bit floats, scaled so that the largest is 1. vglare stores 32 \
     bits; this is what half the memory would cost in accuracy. No time stands here, since nothing was stored in 16 bits."
        .to_owned()
}

pub(super) fn ghosts(results: &Results) -> String {
    let meet = results.crossovers.iter().map(|crossover| match crossover.ghosts {
        Some(count) => format!("{} beats direct from about {count:.0} ghosts on", crossover.evaluator),
        None if crossover.always => format!("{} beats direct with any number", crossover.evaluator),
        None => format!("{} does not beat direct within the sweep", crossover.evaluator),
    });
    let text = format!(
        "Random Gaussians (σ 0.15 to 0.45, always the same ones) at tolerance 1e-3. direct pays for each ghost at each \
         pixel; the others pay for ghosts only once, in the spectrum. At {}: {}.",
        size(results.swept),
        meet.collect::<Vec<_>>().join("; ")
    );
    text + parts(results, Sweep::Ghosts)
}

pub(super) fn size_note(results: &Results) -> String {
    let last = results.points.iter().rfind(|point| point.sweep == Sweep::Size && point.planner);
    let [Some(asked), Some(ms)] = [last.and_then(|point| point.asked), last.and_then(|point| point.ms)] else {
        return String::new();
    };
    let (width, height) = last.map_or((0, 0), |point| (point.width, point.height));
    format!("At --tolerance {asked:e} and {} the planner’s choice takes {} ms. ", size([width, height]), short(ms))
}

pub(super) fn size_plot(results: &Results) -> String {
    let missed = match regret(&results.points, Sweep::Size) {
        Some(times) if times > 1.0 => format!("; at worst it took {} times as long as the fastest one", short(times)),
        _ => String::new(),
    };
    let text = format!(
        "The photo’s own ghosts at the recommended tolerance. {}Rings are the planner’s choices, by constants that were \
         measured {}{missed}.",
        size_note(results),
        if results.calibrated { "here by vglare calibrate" } else { "on another machine" }
    );
    text + parts(results, Sweep::Size)
}

pub(super) fn phases(results: &Results) -> String {
    format!(
        "A series stands on cosines of n·2πx/T with n and x large. In 32-bit floats the product loses its last digits, and \
         recurrences add up what they lose; vglare counts turns in 32-bit integers, which wrap around exactly. Emulated on \
         the processor, the largest error at 275 positions across the picture, up to harmonic 4096, in a period of {:.2} half picture heights.",
        results.phase_period
    )
}

/// The words of the table, explained.
pub(super) fn glossary() -> String {
    let words = [
        ("tolerance", "the largest error that was asked for, relative to the largest glare of the same colour"),
        ("evaluator", "how the field is computed: direct sums all ghosts at each pixel, series and rows a Fourier series of \
                       them, grid the series on a coarse lattice that is then interpolated"),
        ("degree", "the highest harmonics of the series along x and y"),
        ("predicted, measured", "the error that the plan promises to stay below, and the largest that was found, against \
                                 the direct sum in 64-bit floats"),
        ("RMS", "the root mean square error, in the same unit"),
        ("PSNR, ΔE2000", "of the tone-mapped picture with glare against the exact one: peak signal to noise ratio in dB, and \
                          the largest difference in colour, where 1 is about what an eye tells apart side by side"),
        ("fastest here", "the evaluator that was the fastest in this run, where it is not the planner’s: the planner \
                          estimates, it does not try"),
        ("ms", "spectrum, field and composite, until the device is done, with the photo on the device already: the median, \
                the least and the most"),
    ]
    .map(|(word, meaning)| (word.to_owned(), meaning.to_owned()));
    format!("<details><summary>What these mean</summary>{}</details>\n", pairs("", &words))
}
