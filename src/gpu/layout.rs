//! What Rust and GLSL must agree on: binding numbers, and the structs that cross over.
//!
//! Structs hold groups of four f32 or u32 only, so std140 and std430 lay them out as `repr(C)` does. Their sizes are
//! asserted here at compile time; a test has a shader echo them.

use bytemuck::{Pod, Zeroable};

/// A binding number and the name by which shaders know it.
pub(crate) type Binding = (&'static str, u32);

/// Uniform blocks.
pub(crate) const PASS: Binding = ("BINDING_PASS", 0);
/// What an evaluator has beside the pass that asks it.
pub(crate) const EVALUATOR: Binding = ("BINDING_EVALUATOR", 1);
pub(crate) const SAMPLES: Binding = ("BINDING_SAMPLES", 2);

/// What `direct` has, beside an evaluator or alone: where the tile stands, and as many ghosts as fit a uniform block.
pub(crate) const DIRECT: Binding = ("BINDING_DIRECT", 4);
pub(crate) const FEW_GHOSTS: Binding = ("BINDING_FEW_GHOSTS", 3);

/// The taps of a veil's pass.
pub(crate) const TAPS: Binding = ("BINDING_TAPS", 5);

/// Shader storage blocks.
pub(crate) const GHOSTS: Binding = ("BINDING_GHOSTS", 0);
pub(crate) const PARTIALS: Binding = ("BINDING_PARTIALS", 1);
pub(crate) const SPECTRUM: Binding = ("BINDING_SPECTRUM", 2);
pub(crate) const OFFSETS: Binding = ("BINDING_OFFSETS", 3);
pub(crate) const PHASES: Binding = ("BINDING_PHASES", 4);
pub(crate) const PROBES: Binding = ("BINDING_PROBES", 5);
pub(crate) const TABLE: Binding = ("BINDING_TABLE", 6);
pub(crate) const SHAPES: Binding = ("BINDING_SHAPES", 7);

/// Of a series in 64-bit floats, which needs none of those that have these numbers meanwhile: waves along an axis; profiles or
/// strips, or the other axis's waves; and nodes of a lattice, or the canvas of `local`.
pub(crate) const WAVES: Binding = ("BINDING_WAVES", 4);
pub(crate) const SUMS: Binding = ("BINDING_SUMS", 1);
pub(crate) const NODES: Binding = ("BINDING_NODES", 6);

/// Of the measurement of precision, which no other pass is bound for meanwhile.
pub(crate) const ARGUMENTS: Binding = ("BINDING_ARGUMENTS", 0);
pub(crate) const VALUES: Binding = ("BINDING_VALUES", 1);

/// Texture units.
pub(crate) const PHOTO: Binding = ("UNIT_PHOTO", 0);
pub(crate) const FIELD: Binding = ("UNIT_FIELD", 1);
pub(crate) const HARMONICS_X: Binding = ("UNIT_HARMONICS_X", 2);
pub(crate) const HARMONICS_Y: Binding = ("UNIT_HARMONICS_Y", 3);
pub(crate) const PROFILES: Binding = ("UNIT_PROFILES", 4);
pub(crate) const LATTICE: Binding = ("UNIT_LATTICE", 5);
pub(crate) const CELLS: Binding = ("UNIT_CELLS", 6);
pub(crate) const STRIPS: Binding = ("UNIT_STRIPS", 7);
pub(crate) const RANGE: Binding = ("UNIT_RANGE", 8);
/// Where textures are made and filled, so that no pass's own units are disturbed meanwhile.
pub(crate) const WORKBENCH: Binding = ("UNIT_WORKBENCH", 9);

/// Bessel functions, where they are looked up, what Graf's sum is along the radius, and
/// in a quadrant.
pub(crate) const BESSEL: Binding = ("UNIT_BESSEL", 10);
pub(crate) const PLACES: Binding = ("UNIT_PLACES", 11);
pub(crate) const RADIAL: Binding = ("UNIT_RADIAL", 12);
pub(crate) const FOLDED: Binding = ("UNIT_FOLDED", 13);

/// The photo with its glare, where it is looked at.
pub(crate) const PICTURE: Binding = ("UNIT_PICTURE", 14);

/// What `local` draws on.
pub(crate) const CANVAS: Binding = ("UNIT_CANVAS", 15);

/// The first of the layers that are laid over the photo, and how many there are at most.
pub(crate) const OVERLAY: Binding = ("UNIT_OVERLAY", 16);
pub(crate) const OVERLAY_LAYERS: usize = 4;

/// The last of the units.
pub(crate) const LAST_UNIT: u32 = OVERLAY.1 + OVERLAY_LAYERS as u32 - 1;

/// Pixels along a side of the largest square that is drawn as a point.
pub(crate) const LARGEST_POINT: i32 = 64;

/// Every binding, for the head of every shader.
pub(crate) const BINDINGS: [Binding; 35] = [
    PASS,
    EVALUATOR,
    SAMPLES,
    FEW_GHOSTS,
    DIRECT,
    TAPS,
    GHOSTS,
    PARTIALS,
    SPECTRUM,
    OFFSETS,
    PHASES,
    PROBES,
    TABLE,
    SHAPES,
    WAVES,
    SUMS,
    NODES,
    ARGUMENTS,
    VALUES,
    PHOTO,
    FIELD,
    HARMONICS_X,
    HARMONICS_Y,
    PROFILES,
    LATTICE,
    CELLS,
    STRIPS,
    RANGE,
    BESSEL,
    PLACES,
    RADIAL,
    FOLDED,
    PICTURE,
    CANVAS,
    OVERLAY,
];

/// How a value of the field becomes glare: as it is, clamped to 0..1, or stretched to 0..1 by the range.
pub(crate) const NORMALIZE_NONE: Binding = ("NORMALIZE_NONE", 0);
pub(crate) const NORMALIZE_CLAMP: Binding = ("NORMALIZE_CLAMP", 1);
pub(crate) const NORMALIZE_MINMAX: Binding = ("NORMALIZE_MINMAX", 2);

/// How light comes into a display's range.
pub(crate) const TONE_MAP_NONE: Binding = ("TONE_MAP_NONE", 0);
pub(crate) const TONE_MAP_REINHARD: Binding = ("TONE_MAP_REINHARD", 1);
pub(crate) const TONE_MAP_ACES: Binding = ("TONE_MAP_ACES", 2);
pub(crate) const TONE_MAP_AGX: Binding = ("TONE_MAP_AGX", 3);

/// Bits after the point of a place between a lattice's nodes; those of 32 before it count whole nodes.
pub(crate) const KNOT_BITS: u32 = 20;

/// Halvings that find a row among those of a profile's table.
pub(crate) const PROFILE_HALVINGS: u32 = 13;

/// Numbers that passes and their shaders have to agree on, for the head of every shader: work groups, what is done in one
/// round of a loop, and what else a shader counts by.
pub(crate) const NUMBERS: [Binding; 26] = [
    NORMALIZE_NONE,
    NORMALIZE_CLAMP,
    NORMALIZE_MINMAX,
    TONE_MAP_NONE,
    TONE_MAP_REINHARD,
    TONE_MAP_ACES,
    TONE_MAP_AGX,
    ("KNOT_BITS", KNOT_BITS),
    ("PROFILE_HALVINGS", PROFILE_HALVINGS),
    ("SPECTRUM_BATCH", super::spectrum::BATCH),
    ("DIRECT_STEP", super::evaluators::STEP as u32),
    ("DIRECT_BATCH", super::evaluators::BATCH as u32),
    ("DIRECT_FEW_BYTES", super::evaluators::FEW_BYTES),
    ("DIRECT_RUNS", super::evaluators::RUNS as u32),
    ("DOUBLE_GROUP", super::exact::GROUP),
    ("SPLINE_ORDER", super::exact::ORDER),
    ("SPECTRUM_TILE", super::spectrum::TILE),
    ("SPECTRUM_MINE", super::spectrum::MINE),
    ("SPECTRUM_ROWS", super::spectrum::TILE / super::spectrum::MINE),
    ("COEFFICIENT_MODES", super::coefficients::MODES),
    ("SAMPLE_VECTORS", super::coefficients::BLOCK as u32),
    ("GRAF_LANES", super::graf::LANES),
    ("PRECISION_GROUP", super::precision::GROUP),
    ("VEIL_TAPS", super::veil::MOST_TAPS as u32),
    ("VEIL_PERIOD", super::veil::PERIOD as u32),
    ("VEIL_NEAR_ROWS", super::veil::NEAR_ROWS as u32),
];

/// One ghost as the spectrum's shader reads it.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SpectralGhost {
    /// Centre in 2⁻³² of a period.
    pub phase: [u32; 2],
    /// Size in periods.
    pub size: [f32; 2],
    /// Radiance, per colour in units of the field's scale.
    pub weight: [f32; 3],
    pub pad: f32,
}
const _: () = assert!(size_of::<SpectralGhost>() == 32);

/// One ghost as the direct sum reads it.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct DirectGhost {
    /// Centre on the picture plane.
    pub center: [f32; 2],
    /// One over the size.
    pub inverse_size: [f32; 2],
    /// Radiance, per colour in units of the field's scale.
    pub weight: [f32; 3],
    /// Where its bell's parameters begin.
    pub bell: u32,
}
const _: () = assert!(size_of::<DirectGhost>() == 32);

/// One ghost as the direct sum in 64-bit floats reads it.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct DoubleGhost {
    /// Centre on the picture plane.
    pub center: [f64; 2],
    pub size: [f64; 2],
    /// Radiance, per colour in units of the field's scale.
    pub weight: [f64; 3],
    /// As that of a [`DirectGhost`].
    pub bell: u32,
    pub pad: u32,
}
const _: () = assert!(size_of::<DoubleGhost>() == 64);

/// One ghost as `local` draws it, a vertex or an instance.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LocalGhost {
    /// First column and row that it covers, and those after the last, in pixels of the picture.
    pub area: [i32; 4],
    /// The pixel that is nearest to its centre.
    pub anchor: [i32; 2],
    /// From its centre to there, in sizes.
    pub offset: [f32; 2],
    /// From there to the next column and row.
    pub step: [f32; 2],
    /// Radiance, per colour in units of the field's scale.
    pub weight: [f32; 3],
    /// As that of a [`DirectGhost`].
    pub bell: u32,
}
const _: () = assert!(size_of::<LocalGhost>() == 56);

impl DoubleGhost {
    /// None at all; of size 0 it would be 0 / 0 at its centre.
    pub const NONE: Self = Self { center: [0.0; 2], size: [1.0; 2], weight: [0.0; 3], bell: 0, pad: 0 };
}

/// A ghost of either that is summed at every pixel.
pub(crate) trait SummedGhost: Pod {
    /// The same, so that it adds nothing.
    fn without_weight(&self) -> Self;
}

impl SummedGhost for DirectGhost {
    fn without_weight(&self) -> Self {
        Self { weight: [0.0; 3], ..*self }
    }
}

impl SummedGhost for DoubleGhost {
    fn without_weight(&self) -> Self {
        Self { weight: [0.0; 3], ..*self }
    }
}

/// Where the pixels along one axis lie between the lattice's nodes: pixel i at `start + i * pitch`, counted from the second
/// node that the tile has, with [`KNOT_BITS`] bits after the point and 16 more, which carry.
///
/// Integers, so that every tile gives a pixel the same place, bit for bit, and a shader needs no table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Knots {
    pub start: u32,
    pub pitch: u32,
    /// Nodes that the tile has along the axis.
    pub nodes: u32,
    /// The bits that follow those of `start`, above those that follow `pitch`.
    pub fine: u32,
}
const _: () = assert!(size_of::<Knots>() == 16);

/// Bits that [`Knots::fine`] has of either.
pub(crate) const FINE_BITS: u32 = 16;
