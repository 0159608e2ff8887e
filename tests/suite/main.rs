//! The promises, one module each.

mod cli;
mod composite;
mod evaluators;
mod golden;
mod layers;
mod order;
mod orientation;
mod photo;
mod plan;
mod range;
mod reference;
mod rounding;
mod scale;
mod scene;
mod sphere;
mod support;
mod tiles;
