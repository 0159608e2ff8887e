//! Numbers in files, checked while they are read, so that an error knows the line.
//!
//! Whole numbers are taken wherever a number is expected. Numbers end up as f32 on the GPU and have to fit there.

use std::fmt;
use std::marker::PhantomData;

use glam::DVec2;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected, Visitor};

/// What a number must be.
pub(super) trait Allowed {
    /// In words, as in "expected …".
    const EXPECTED: &'static str;
    /// Whether it is.
    fn holds(x: f64) -> bool;
}

/// A number of a range.
pub(super) struct Number<R>(pub f64, PhantomData<R>);

/// Any finite number.
pub(super) type Finite = Number<IsFinite>;
/// A finite number, 0 or more.
pub(super) type NotNegative = Number<IsNotNegative>;
/// A finite number above 0.
pub(super) type Positive = Number<IsPositive>;

pub(super) struct IsFinite;
pub(super) struct IsNotNegative;
pub(super) struct IsPositive;
pub(super) struct IsFraction;
pub(super) struct IsFactor;
pub(super) struct IsField;

impl Allowed for IsFinite {
    const EXPECTED: &'static str = "a finite number";
    fn holds(x: f64) -> bool {
        x.abs() <= f64::from(f32::MAX)
    }
}

impl Allowed for IsNotNegative {
    const EXPECTED: &'static str = "a finite number that is not negative";
    fn holds(x: f64) -> bool {
        IsFinite::holds(x) && x >= 0.0
    }
}

impl Allowed for IsPositive {
    const EXPECTED: &'static str = "a positive finite number";
    fn holds(x: f64) -> bool {
        IsFinite::holds(x) && x >= f64::from(f32::MIN_POSITIVE)
    }
}

impl Allowed for IsFraction {
    const EXPECTED: &'static str = "a number between 0 and 1";
    fn holds(x: f64) -> bool {
        x > 0.0 && x < 1.0
    }
}

impl Allowed for IsFactor {
    const EXPECTED: &'static str = "0, or a finite number of at least 1";
    fn holds(x: f64) -> bool {
        x == 0.0 || (IsFinite::holds(x) && x >= 1.0)
    }
}

impl Allowed for IsField {
    const EXPECTED: &'static str = "a field of view from 0.1 to 360 degrees";
    fn holds(x: f64) -> bool {
        (0.1..=360.0).contains(&x)
    }
}

impl<R> Number<R> {
    pub fn new(x: f64) -> Self {
        Self(x, PhantomData)
    }
}

/// The plain numbers of an array.
pub(super) fn plain<R, const N: usize>(numbers: [Number<R>; N]) -> [f64; N] {
    numbers.map(|number| number.0)
}

impl<'de, R: Allowed> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(NumberVisitor(PhantomData))
    }
}

struct NumberVisitor<R>(PhantomData<R>);

impl<R: Allowed> Visitor<'_> for NumberVisitor<R> {
    type Value = Number<R>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(R::EXPECTED)
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Self::Value, E> {
        if R::holds(x) {
            Ok(Number::new(x))
        } else {
            Err(E::custom(format_args!("expected {}, found {x}", R::EXPECTED)))
        }
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<Self::Value, E> {
        self.visit_f64(x as f64)
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<Self::Value, E> {
        self.visit_f64(x as f64)
    }
}

/// One size for both axes, or \[x, y\].
pub(super) struct Sizes(pub DVec2);

impl<'de> Deserialize<'de> for Sizes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SizesVisitor)
    }
}

struct SizesVisitor;

impl<'de> Visitor<'de> for SizesVisitor {
    type Value = Sizes;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a positive size or two, [x, y]")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Sizes, E> {
        let size: Positive = NumberVisitor(PhantomData).visit_f64(x)?;
        Ok(Sizes(DVec2::splat(size.0)))
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<Sizes, E> {
        self.visit_f64(x as f64)
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<Sizes, E> {
        self.visit_f64(x as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sizes: A) -> Result<Sizes, A::Error> {
        let mut next = |index| sizes.next_element::<Positive>()?.ok_or_else(|| A::Error::invalid_length(index, &self));
        let size = DVec2::new(next(0)?.0, next(1)?.0);
        match sizes.next_element::<Positive>()? {
            None => Ok(Sizes(size)),
            Some(_) => Err(A::Error::invalid_length(3, &self)),
        }
    }
}

/// The highest harmonic along an axis, 0 to [`Degree::MAX`].
pub(super) struct Degree(pub u32);

impl Degree {
    /// Far beyond what a series is good for; a spectrum of this degree along both axes has 200 million terms.
    pub const MAX: u32 = 4096;
}

impl<'de> Deserialize<'de> for Degree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_u64(DegreeVisitor)
    }
}

struct DegreeVisitor;

impl Visitor<'_> for DegreeVisitor {
    type Value = Degree;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a whole number from 0 to {}", Degree::MAX)
    }

    fn visit_i64<E: Error>(self, n: i64) -> Result<Degree, E> {
        match u32::try_from(n) {
            Ok(degree @ 0..=Degree::MAX) => Ok(Degree(degree)),
            _ => Err(E::invalid_value(Unexpected::Signed(n), &self)),
        }
    }

    fn visit_u64<E: Error>(self, n: u64) -> Result<Degree, E> {
        self.visit_i64(i64::try_from(n).unwrap_or(i64::MAX))
    }
}
