//! The promises, one module each.

mod bells;
mod certificate;
mod cli;
mod composite;
mod evaluators;
mod experiments;
mod extremes;
mod fourier_bessel;
mod golden;
mod graf;
mod layers;
mod numeric;
mod order;
mod orientation;
mod photo;
mod plan;
mod printed;
mod range;
mod reference;
mod rounding;
mod scale;
mod scene;
mod special;
mod sphere;
mod support;
mod tiles;
