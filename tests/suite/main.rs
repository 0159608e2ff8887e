//! The promises, one module each.

// Tests tell what they measured; the harness shows it where they fail.
#![allow(clippy::print_stderr, clippy::print_stdout)]

mod adopt;
mod bells;
mod certificate;
mod cli;
mod composite;
mod discs;
mod evaluators;
mod exact;
mod exchange;
mod experiments;
mod extremes;
mod fourier_bessel;
mod golden;
mod graf;
mod layered;
mod layers;
mod light;
mod local;
mod moments;
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
mod split;
mod steep;
mod support;
mod tiles;
mod view;
mod viewer;
mod viewer_fuzz;
mod viewer_lost;
mod viewer_panels;
mod viewer_scale;
mod window;
