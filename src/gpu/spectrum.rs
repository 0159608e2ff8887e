//! The spectrum: ghosts in, A, B, C, D of every kept mode out, one dispatch a group; or sums over ghosts in, where these
//! were gathered elsewhere.

use super::layout::{GHOSTS, OFFSETS, PARTIALS, PASS, SPECTRUM, SpectralGhost, TABLE};
use super::resource::Buffer;
use super::runner::Runner;
use crate::Result;

/// Modes along each side of a work group's tile.
pub(super) const TILE: u32 = 8;
/// And so many of a tile's are one invocation's.
pub(super) const MINE: u32 = 4;
/// Ghosts whose factors a work group prepares together.
pub(super) const BATCH: u32 = 32;
/// A slice is at least this many ghosts: fewer would cost more in summing slices than they win in parallel.
const SHORTEST_SLICE: usize = 128;
/// And at most this many: a longer one would need more rounds of its loops than Mesa's software renderer runs (65535) before
/// it ends them without a word. A batch takes one for each ghost, and less than so many others.
const LONGEST_SLICE: usize = 1 << 15;
const BESIDE: usize = 17;
const _: () = assert!(LONGEST_SLICE / BATCH as usize * (BATCH as usize + BESIDE) <= 65535);
/// And there are at most this many slices.
const MOST_SLICES: usize = 64;
/// Room for the slices' sums, in vec4s: 32 MiB.
const PARTIALS_LIMIT: usize = 2 << 20;

/// Ghosts of one bell, with the modes that they need.
pub(crate) struct SpectrumGroup<'a> {
    pub coefficients: Coefficients<'a>,
    pub ghosts: Ghosts<'a>,
    /// Highest harmonics in x and y that this group adds to.
    pub degree: [u32; 2],
}

/// What there is of a group's ghosts.
#[derive(Clone, Copy)]
pub(crate) enum Ghosts<'a> {
    /// Each of them.
    Each(&'a [SpectralGhost]),
    /// The sums of cos cos, cos sin, sin cos and sin sin of their phases times their weights, of all modes up to the
    /// group's degree, the harmonic of x running fastest. Their bell has to come as a table.
    Sums(&'a [[[f64; 4]; 3]]),
}

/// Where the Fourier coefficients of a group's bell come from.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Coefficients<'a> {
    /// From its file in `shaders/`, as a product of factors; every ghost may have a size of its own.
    Factors(&'a str),
    /// From a table that all ghosts of the group share: for each kept mode what stands before c_n c_m, s_n s_m, c_n s_m
    /// and s_n c_m in the series of the bell about its own centre, the mode's weight 1, 2 or 4 included.
    Table(&'a [[f32; 4]]),
}

/// The spectrum's tables on the device.
pub(crate) struct Spectrum {
    terms: Buffer<[f32; 4]>,
    offsets: Buffer<u32>,
    degree: [u32; 2],
    term_count: usize,
    ghosts: Buffer<SpectralGhost>,
    partials: Buffer<[f32; 4]>,
    table: Buffer<[f32; 4]>,
    uniforms: Buffer<[u32; 4]>,
}

impl Spectrum {
    /// Tables with no term yet.
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            terms: Buffer::new(device, 0)?,
            offsets: Buffer::from_slice(device, &[0, 0])?,
            degree: [0; 2],
            term_count: 0,
            ghosts: Buffer::new(device, 0)?,
            partials: Buffer::new(device, 0)?,
            table: Buffer::new(device, 0)?,
            uniforms: Buffer::new(device, 1)?,
        })
    }

    /// Fills the tables. `counts[n]` says how many harmonics in y are kept beside harmonic n in x.
    pub fn compute(&mut self, runner: &Runner, counts: &[u32], groups: &[SpectrumGroup<'_>]) -> Result<()> {
        let terms = self.begin(counts)?;
        self.terms.store(&vec![[0.0; 4]; 3 * terms])?;
        for group in groups {
            match group.ghosts {
                Ghosts::Each(ghosts) => {
                    for ghosts in ghosts.chunks(Self::most_slices(group.degree) * LONGEST_SLICE) {
                        let slices = self.dispatch(runner, group, ghosts)?;
                        self.add(runner, group, slices)?;
                    }
                }
                Ghosts::Sums(sums) => {
                    self.partials.store(&packed(sums, group.degree))?;
                    self.add(runner, group, 1)?;
                }
            }
        }
        Ok(())
    }

    /// Takes terms that were computed elsewhere, three a mode: A, B, C, D of red, green and blue, harmonic by harmonic of x.
    pub fn upload(&mut self, counts: &[u32], terms: &[[f32; 4]]) -> Result<()> {
        let count = self.begin(counts)?;
        assert_eq!(terms.len(), 3 * count, "three for each kept mode");
        self.terms.store(terms)
    }

    /// Says which modes are kept, and how many they are.
    fn begin(&mut self, counts: &[u32]) -> Result<usize> {
        let mut offsets = vec![0];
        offsets.extend(counts.iter().scan(0, |end, count| {
            *end += count;
            Some(*end)
        }));
        let terms = *offsets.last().expect("begins with one") as usize;
        self.degree = [counts.len().max(1) as u32 - 1, counts.iter().max().map_or(0, |most| most.max(&1) - 1)];
        self.term_count = terms;
        offsets.insert(0, counts.len() as u32);
        self.offsets.store(&offsets)?;
        Ok(terms)
    }

    /// How many slices' sums there is room for.
    fn most_slices(degree: [u32; 2]) -> usize {
        (PARTIALS_LIMIT / Self::vectors(degree)).clamp(1, MOST_SLICES)
    }

    /// How many vec4s the sums of one slice are.
    fn vectors(degree: [u32; 2]) -> usize {
        let tiles = tiles(degree);
        3 * (tiles[0] * tiles[1] * TILE * TILE) as usize
    }

    /// Sums some of a group's ghosts in slices, and says in how many.
    fn dispatch(&mut self, runner: &Runner, group: &SpectrumGroup<'_>, ghosts: &[SpectralGhost]) -> Result<u32> {
        let tiles = tiles(group.degree);
        let vectors = Self::vectors(group.degree);
        let most = Self::most_slices(group.degree);
        let slice_length = SHORTEST_SLICE.max(ghosts.len().div_ceil(most));
        let slices = ghosts.len().div_ceil(slice_length) as u32;

        self.ghosts.store(ghosts)?;
        if self.partials.length() < slices as usize * vectors {
            self.partials = Buffer::new(runner.device(), slices as usize * vectors)?;
        }
        self.ghosts.bind_storage(GHOSTS);
        self.partials.bind_storage(PARTIALS);
        self.bind();
        let [n, m] = group.degree;
        self.uniforms.store(&[[ghosts.len() as u32, slice_length as u32, n, m]])?;
        self.uniforms.bind_uniform(PASS);
        let bell = match group.coefficients {
            Coefficients::Factors(bell) => bell,
            Coefficients::Table(_) => "bells/point.glsl",
        };
        runner.dispatch("spectrum.comp", &[("BELL", &format!("\"{bell}\""))], [tiles[0], tiles[1], slices])?;
        Ok(slices)
    }

    /// Adds the sums of some slices to the spectrum.
    fn add(&mut self, runner: &Runner, group: &SpectrumGroup<'_>, slices: u32) -> Result<()> {
        self.partials.bind_storage(PARTIALS);
        self.bind();
        let ([n, m], tiles) = (group.degree, tiles(group.degree));
        self.uniforms.store(&[[n, m, slices, 0]])?;
        self.uniforms.bind_uniform(PASS);
        let table = match group.coefficients {
            Coefficients::Factors(_) => "0",
            Coefficients::Table(table) => {
                assert_eq!(table.len(), self.term_count, "a coefficient for each kept mode");
                self.table.store(table)?;
                self.table.bind_storage(TABLE);
                "1"
            }
        };
        runner.dispatch("spectrum_sum.comp", &[("TABULATED", table)], [tiles[0], tiles[1], 1])
    }

    /// Rounds every term as 16-bit floats would hold it, were the largest 1.
    pub fn round_to_half(&mut self) -> Result<()> {
        let mut terms = self.read();
        let values = terms.as_flattened_mut();
        let largest = values.iter().fold(0.0f32, |largest, value| largest.max(value.abs()));
        if largest > 0.0 {
            values.iter_mut().for_each(|value| *value = half::f16::from_f32(*value / largest).to_f32() * largest);
        }
        self.terms.store(&terms)
    }

    /// The terms, three a mode: A, B, C, D of red, green and blue.
    pub fn read(&self) -> Vec<[f32; 4]> {
        self.terms.read(3 * self.term_count)
    }

    /// Makes the tables visible to the passes.
    pub fn bind(&self) {
        self.terms.bind_storage(SPECTRUM);
        self.offsets.bind_storage(OFFSETS);
    }

    /// How many modes are kept.
    pub fn terms(&self) -> usize {
        self.term_count
    }

    /// Highest harmonics in x and y that are kept.
    pub fn degree(&self) -> [u32; 2] {
        self.degree
    }
}

/// Work groups along x and y.
fn tiles(degree: [u32; 2]) -> [u32; 2] {
    degree.map(|degree| (degree + 1).div_ceil(TILE))
}

/// Sums as one slice of partials.
fn packed(sums: &[[[f64; 4]; 3]], degree: [u32; 2]) -> Vec<[f32; 4]> {
    let columns = degree[0] as usize + 1;
    let stride = (tiles(degree)[0] * TILE) as usize;
    let mut partials = vec![[0.0; 4]; Spectrum::vectors(degree)];
    for (row, sums) in partials.chunks_exact_mut(3 * stride).zip(sums.chunks_exact(columns)) {
        for (partial, sum) in row.iter_mut().zip(sums.as_flattened()) {
            *partial = sum.map(|value| value as f32);
        }
    }
    partials
}
