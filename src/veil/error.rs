//! What can go wrong when a veil is planned or evaluated.

/// Why there is no veil.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A picture without pixels, or with more than a lattice counts.
    #[error("a picture of {width} × {height} pixels has no veil: each side is from 1 to {most}")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// The longest side.
        most: usize,
    },

    /// A photo whose values are not as many as its size says, or not of the size that was planned.
    #[error("the photo holds {found} values where {expected} were expected")]
    Length {
        /// Values that there are.
        found: usize,
        /// Values that its size asks for.
        expected: usize,
    },

    /// A photo of another size than the plan's.
    #[error("the veil was planned for {} × {} pixels, and the photo has {} × {}", planned[0], planned[1], found[0], found[1])]
    OtherSize {
        /// Columns and rows of the plan.
        planned: [usize; 2],
        /// Columns and rows of the photo.
        found: [usize; 2],
    },

    /// A geometry that is not one.
    #[error("{0}")]
    Geometry(String),

    /// A kernel that is not one.
    #[error("{0}")]
    Kernel(String),

    /// A tolerance that is none.
    #[error("the tolerance of a veil is above 0 and below 1, relative to the local veil, and not {0}")]
    Tolerance(f64),

    /// The mixture and the lattices do not come as close to the kernel as was asked.
    #[error(
        "the veil cannot be had to {asked:.1e} of itself: the best plan comes to {best:.1e}, at {distance:.1} pixels from a \
         source; ask for less, or give a mixture that is closer to the function"
    )]
    OutOfReach {
        /// What was asked.
        asked: f64,
        /// The bound of the best plan.
        best: f64,
        /// Where it is worst, in pixels.
        distance: f64,
    },

    /// No mixture follows the kernel's core, and no small kernel is as wide.
    #[error(
        "the veil cannot be had to {asked:.1e} of itself: the function's core, which no mixture follows, is wider than the \
         {most} pixels that are summed one by one; give a wider field, a smaller photo or a looser tolerance"
    )]
    Core {
        /// What was asked.
        asked: f64,
        /// How far small kernels reach, in pixels.
        most: usize,
    },

    /// A transform that is too large for the memory.
    #[error(
        "the veil of this photo takes {:.1} GiB of memory, and {:.1} GiB are the most that are used; give a smaller photo, no \
         border or a smaller kernel", gib(*needed), gib(*most)
    )]
    Memory {
        /// Bytes that would be needed.
        needed: usize,
        /// Bytes that are taken at most.
        most: usize,
    },
}

fn gib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 30)
}
