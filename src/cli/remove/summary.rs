//! What a person is told.

use std::io::{self, Write};

use super::report::{Luminance, Report};
use crate::Result;
use crate::cli::luminance;
use crate::cli::plan::text;
use crate::job::{Amplification, Negative, Removal, VeilSeen};
use crate::photo::Facts;
use crate::terminal::{stderr, stdout};

/// Warnings to standard error; unless quiet, a short summary to standard output, where no file goes there.
pub fn print(report: &Report<'_>) -> Result<()> {
    let Report { args, facts: Facts { frame, format, depth, .. }, removed, stages, luminance } = report;
    stderr::warn(&removed.warnings);
    if args.quiet {
        return Ok(());
    }
    stdout::summary(args.takes_stdout(), |out| {
        writeln!(out, "photo    {}: {} x {}, {format}, {depth}", args.input.display(), frame.width, frame.height)?;
        match &removed.removal {
            Some(removal) => about(out, removal)?,
            None => writeln!(out, "veil     none, so nothing is taken away")?,
        }
        if let Some(Luminance { scale, photo, clean }) = luminance {
            luminance::line(out, scale, [("photo", photo), ("clean", clean)])?;
        }
        let total: f64 = stages.0.iter().map(|(_, ms)| ms).sum();
        let written: Vec<_> =
            [&args.output, &args.mask].into_iter().flatten().map(|path| path.display().to_string()).collect();
        match &written[..] {
            [] => writeln!(out, "done     in {:.2} s, without a picture", total * 1e-3),
            written => writeln!(out, "wrote    {} in {:.2} s", written.join(" and "), total * 1e-3),
        }
    })
}

fn about(out: &mut dyn Write, removal: &Removal) -> io::Result<()> {
    let Removal { seen, strength, scattered, terms, summed_by, method, steps, veils, error, .. } = removal;
    let VeilSeen { parameters, projection, fov, fov_from, border: _ } = seen;
    write!(out, "veil     {}", parameters.psf)?;
    if let Some((fov, from)) = fov.zip(fov_from.as_ref()) {
        let projection = format!("{projection:?}").to_lowercase();
        write!(out, ", {from}: {} across a {projection} picture", text::angle(fov))?;
    }
    let share = 100.0 * strength * scattered.iter().sum::<f64>() / 3.0;
    writeln!(out, ": scatters {share:.1} % of the light, by {}", text::summed(summed_by, *terms))?;
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    write!(out, "removed  by {method}, {steps} step{}, {veils} sum{} of the veil", plural(*steps), plural(*veils))?;
    let contraction = removal.contraction.into_iter().fold(0.0, f64::max);
    writeln!(out, "; a step of the series leaves at most {contraction:.3} of what was left")?;
    let Amplification { largest, rms } = removal.amplification;
    let factors = [(largest, "in the largest sample"), (rms, "in the root of the mean square")];
    let factors: Vec<String> =
        factors.iter().filter_map(|(factor, of)| factor.map(|factor| format!("{factor:.3} times {of}"))).collect();
    writeln!(out, "noise    grows at most {}", factors.join(", "))?;
    let Negative { samples, surely, deepest, .. } = removal.negative;
    if samples > 0 {
        writeln!(
            out,
            "negative {samples} samples that were not, down to {deepest:.1e} of the brightest; {surely} of them by more than the error"
        )?;
    }
    writeln!(
        out,
        "error    by the brightest sample of each colour: at most {:.1e}, {:.1e} asked; veiled again, {:.1e} from the photo at {} pixels",
        error.predicted, error.asked, error.measured, error.pixels
    )
}
