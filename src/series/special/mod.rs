//! Special functions in f64: what bells and their series are made of.
//!
//! | file | what |
//! | --- | --- |
//! | `bessel_j` | J_n of one order and of all orders |
//! | `bessel_i` | e^−κ I_n(κ), the coefficients of the von Mises bell |
//! | `bspline` | cardinal B-splines |
//! | `cubics` | J_0 to J_M as piecewise cubics |
//! | `zeros` | the zeros of J_0 |
//! | `kernels` | the transforms of the parabola and of the paraboloid, safe at 0 |
//! | `error_function` | erf, and the windowed Gaussian's complex one |

mod bessel_i;
mod bessel_j;
mod bspline;
mod cubics;
mod error_function;
mod kernels;
mod zeros;

pub use bessel_i::{ive, ive_all};
pub use bessel_j::{Factorial, bessel_j, bessel_j_all, bessel_j_series};
pub use bspline::bspline;
pub use cubics::bessel_cubics;
pub use error_function::{erf, re_erf_scaled};
pub use kernels::{parabola_kernel, paraboloid_kernel, paraboloid_kernel_looked_up};
pub use zeros::{J0Zero, j0_zeros};
