//! Coefficients by sampling on the GPU, as the prototype's plug-in has it (002): a work group a ghost, a thread a mode,
//! then the sum over the ghosts.

use bytemuck::{Pod, Zeroable};

use super::layout::{PARTIALS, PASS, SAMPLES, SPECTRUM};
use super::resource::Buffer;
use super::runner::Runner;
use crate::{Error, Result};

/// Modes of a work group.
pub(super) const MODES: u32 = 64;
/// vec4s of the uniform block: 16 KiB, the most that every OpenGL 4.3 has.
pub(super) const BLOCK: usize = 1024;
/// Samples of one ghost that the block has room for.
pub(crate) const MOST_SAMPLES: usize = 4 * BLOCK;
/// The highest degree: the notes' plug-in has 20, and nothing here needs thousands.
const MOST_MODES: usize = 1 << 16;

/// One dispatch's uniforms; as in `coefficients.comp`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Dispatch {
    pub sample_count: u32,
    pub mode_count: u32,
    pub turns: u32,
    pub first_ghost: u32,
    pub gain: f32,
    pub pad: [f32; 3],
}
const _: () = assert!(size_of::<Dispatch>() == 32);

/// How the samples lie; see [`crate::series::numeric::Rule`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampling {
    /// Periods that they are taken to cover.
    pub turns: u32,
    /// What the mean is multiplied by.
    pub gain: f32,
}

/// Computes coefficients from samples.
pub(crate) struct CoefficientsPass {
    samples: Buffer<[f32; 4]>,
    coefficients: Buffer<[f32; 2]>,
    sums: Buffer<[f32; 2]>,
    uniforms: Buffer<Dispatch>,
}

impl CoefficientsPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            samples: Buffer::new(device, BLOCK)?,
            coefficients: Buffer::new(device, 0)?,
            sums: Buffer::new(device, 0)?,
            uniforms: Buffer::new(device, 1)?,
        })
    }

    /// (a_n, b_n) for n = 0 to `degree` of the sum of all ghosts, each given by the same number of samples.
    ///
    /// As many ghosts share a dispatch as the uniform block has room for.
    ///
    /// # Errors
    /// [`Error::Usage`] where a ghost has no samples or more than [`MOST_SAMPLES`], or the degree is beyond reason;
    /// [`Error::Gl`] where a buffer cannot be had.
    pub fn sum(&mut self, runner: &Runner, ghosts: &[Vec<f32>], degree: u32, how: Sampling) -> Result<Vec<[f32; 2]>> {
        let modes = degree as usize + 1;
        self.each(runner, ghosts, degree, how)?;
        if self.sums.length() < modes {
            self.sums = Buffer::new(runner.device(), modes)?;
        }
        let [sample_count, mode_count] = [ghosts.len() as u32, modes as u32];
        self.uniforms.store(&[Dispatch { sample_count, mode_count, ..Dispatch::zeroed() }])?;
        self.uniforms.bind_uniform(PASS);
        self.coefficients.bind_storage(PARTIALS);
        self.sums.bind_storage(SPECTRUM);
        runner.dispatch("coefficients_sum.comp", &[], [mode_count.div_ceil(MODES), 1, 1])?;
        runner.device().check("summing coefficients")?;
        Ok(self.sums.read(modes))
    }

    /// Fills the buffer of every ghost's coefficients.
    fn each(&mut self, runner: &Runner, ghosts: &[Vec<f32>], degree: u32, how: Sampling) -> Result<()> {
        let (count, modes) = (ghosts.first().map_or(1, Vec::len), degree as usize + 1);
        if ghosts.iter().any(|ghost| ghost.len() != count) || !(1..=MOST_SAMPLES).contains(&count) {
            return Err(Error::Usage(format!(
                "each ghost needs the same number of samples, 1 to {MOST_SAMPLES}: a uniform block holds no more"
            )));
        }
        if modes > MOST_MODES {
            return Err(Error::Usage(format!("a degree of {degree} is beyond the {} that fit", MOST_MODES - 1)));
        }
        if self.coefficients.length() < ghosts.len() * modes {
            self.coefficients = Buffer::new(runner.device(), ghosts.len() * modes)?;
        }
        let room = BLOCK / count.div_ceil(4);
        for (index, batch) in ghosts.chunks(room).enumerate() {
            self.samples.store(&packed(batch))?;
            self.samples.bind_uniform(SAMPLES);
            self.uniforms.store(&[Dispatch {
                sample_count: count as u32,
                mode_count: modes as u32,
                turns: how.turns,
                first_ghost: (index * room) as u32,
                gain: how.gain,
                pad: [0.0; 3],
            }])?;
            self.uniforms.bind_uniform(PASS);
            self.coefficients.bind_storage(PARTIALS);
            let groups = [batch.len() as u32, (modes as u32).div_ceil(MODES), 1];
            runner.dispatch("coefficients.comp", &[], groups)?;
        }
        Ok(())
    }
}

/// Samples four to a vec4, each ghost from a vec4 of its own, the block filled up with zeros.
fn packed(ghosts: &[Vec<f32>]) -> Vec<[f32; 4]> {
    let four = |chunk: &[f32]| {
        let mut vector = [0.0; 4];
        vector[..chunk.len()].copy_from_slice(chunk);
        vector
    };
    let mut vectors: Vec<_> = ghosts.iter().flat_map(|ghost| ghost.chunks(4).map(four)).collect();
    vectors.resize(BLOCK, [0.0; 4]);
    vectors
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::gpu::tests::turn;
    use crate::gpu::{Backend, Device};
    use crate::series::numeric::{Coefficients, Rule, Slips, sine_gaussian};

    /// Ghosts' samples in f32, and the coefficients of just these samples in f64.
    fn ghosts(rule: Rule, count: usize, degree: u32) -> (Vec<Vec<f32>>, Coefficients) {
        let mut sum: Option<Coefficients> = None;
        let samples = (0..count).map(|k| {
            let bell = sine_gaussian(0.9 * (k as f64 / count as f64) - 0.2, 0.1 + 0.01 * (k % 7) as f64);
            let samples: Vec<f32> = rule.sample(bell).into_iter().map(|value| value as f32).collect();
            let exact: Vec<f64> = samples.iter().map(|&value| f64::from(value)).collect();
            let one = rule.coefficients(&exact, degree);
            sum = Some(sum.take().map_or(one.clone(), |sum| sum.plus(&one)));
            samples
        });
        let samples: Vec<_> = samples.collect();
        (samples, sum.expect("there is a ghost"))
    }

    fn worst(rule: Rule, count: usize, degree: u32, runner: &Runner) -> f64 {
        let (samples, exact) = ghosts(rule, count, degree);
        let how = Sampling { turns: rule.turns(), gain: rule.gain() as f32 };
        let got = CoefficientsPass::new(runner).unwrap().sum(runner, &samples, degree, how).unwrap();
        assert_eq!(got.len(), exact.terms.len());
        let errors = got.iter().zip(&exact.terms).flat_map(|(got, exact)| {
            got.iter().zip(exact).map(|(got, exact)| (f64::from(*got) - exact).abs()).collect::<Vec<_>>()
        });
        errors.fold(0.0, |worst, error| if error.is_nan() || error > worst { error } else { worst })
    }

    #[test]
    fn the_gpu_gives_what_the_cpu_gives() {
        let _turn = turn();
        for backend in Backend::ALL {
            let runner = Runner::new(&Device::open(&[backend]).expect("these tests need GL")).unwrap();
            // The notes' own; a count that is no multiple of four; several dispatches; the most that fits.
            for (samples, count, degree) in [(1000, 2, 10), (999, 2, 60), (403, 50, 90), (4096, 3, 200), (1, 1, 0)] {
                for slips in [Slips::default(), Slips::ALL] {
                    let rule = Rule { period: TAU, samples, slips };
                    let worst = worst(rule, count, degree, &runner);
                    println!("{backend}: {samples} samples, {count} ghosts, degree {degree}: {worst:.1e}");
                    // A coefficient of one ghost is a mean of values up to 1, doubled once or twice: some roundings of
                    // that, where one is 6e-8.
                    let limit = 6e-8 * rule.gain() * count as f64;
                    assert!(worst <= limit, "{backend} {samples} {count} {degree} {slips:?}: {worst:e}");
                }
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let _turn = turn();
        let runner = Runner::new(&Device::open(&Backend::ALL).expect("these tests need GL")).unwrap();
        let mut pass = CoefficientsPass::new(&runner).unwrap();
        let how = Sampling { turns: 1, gain: 1.0 };
        for ghosts in [vec![vec![0.0; MOST_SAMPLES + 1]], vec![Vec::new()], vec![vec![0.0; 3], vec![0.0; 4]]] {
            assert!(matches!(pass.sum(&runner, &ghosts, 3, how), Err(Error::Usage(_))));
        }
        assert_eq!(pass.sum(&runner, &[], 3, how).unwrap(), [[0.0; 2]; 4], "no ghost, no light");
    }
}
