//! What an evaluator costs: a handful of constants, one for each kind of work.

use super::{Evaluator, Plan, Request};

/// Nanoseconds on a software renderer (llvmpipe, 256 bits) on two cores at 1920 × 1080: medians of one run of
/// `vglare bench --rounds 8`, less what a copy takes, divided by the work; while a copy took 3 to 5 ns a pixel. The plan
/// needs their ratios only, and those hold well enough on a real GPU, where everything is about a thousand times faster.
mod nanoseconds {
    /// One bell at one pixel: `direct`, K = 45.
    pub const BELL: f64 = 4.0;
    /// One term of the series at one pixel: `series`, N = M = 10.
    pub const TERM: f64 = 5.4;
    /// One harmonic of a row's profile at one pixel: `rows`, N = 10 (3.0) and 57 (2.7).
    pub const HARMONIC: f64 = 2.8;
    /// One term on the way to a row's profiles: `rows`, N = 57.
    pub const PROFILE: f64 = 7.0;
    /// One cell of the lattice stretched to one row: `grid`, K = 1000 (25) and 45 (36).
    pub const STRIP: f64 = 27.0;
    /// One interpolation at one pixel: `grid`, the same two (7.3 and 8.4).
    pub const INTERPOLATION: f64 = 7.5;
    /// One term of one ghost, roughly: K = 1000 (3 to 8, with what else the machine did) and, at N = M = 10 where half
    /// of the tiles' modes are idle, K = 100,000 (16).
    pub const SPECTRUM: f64 = 6.0;
    /// Starting a pass: what the smallest take.
    pub const PASS: f64 = 100_000.0;
}

/// What one evaluator is expected to cost.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Cost {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Milliseconds on the machine that the constants were measured on.
    pub milliseconds: f64,
}

/// The cost of a plan.
pub(super) fn estimate(plan: &Plan, request: &Request) -> Cost {
    use nanoseconds::*;
    let window = request.frame.window;
    let pixels = window.pixels() as f64;
    let rows = |rows: f64, columns: f64| {
        rows * plan.terms as f64 * PROFILE + rows * columns * f64::from(plan.degree[0] + 1) * HARMONIC
    };
    let spectrum: f64 = plan
        .groups
        .iter()
        .map(|group| group.ghosts as f64 * f64::from(group.degree[0] + 1) * f64::from(group.degree[1] + 1) * SPECTRUM)
        .sum();
    let field = match plan.evaluator {
        Evaluator::Direct => pixels * plan.ghosts() as f64 * BELL + PASS,
        Evaluator::Series => spectrum + pixels * plan.terms as f64 * TERM + 4.0 * PASS,
        Evaluator::Rows => spectrum + rows(f64::from(window.height), f64::from(window.width)) + 5.0 * PASS,
        Evaluator::Grid => {
            let [columns, lines] = plan.lattice.map_or([0.0; 2], |lattice| lattice.nodes.map(f64::from));
            let strips = columns * f64::from(window.height);
            spectrum + rows(lines, columns) + strips * STRIP + pixels * INTERPOLATION + 7.0 * PASS
        }
    };
    Cost { evaluator: plan.evaluator, milliseconds: field * 1e-6 }
}
