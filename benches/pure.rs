//! What runs on the CPU alone: lights, plans, the reference, pictures on their way out.

use divan::{Bencher, black_box};
use glam::DVec2;
use vglare::frame::Frame;
use vglare::photo::{self, ToneMap, WriteOptions};
use vglare::plan::{Evaluator, Request, plan};
use vglare::problem::Problem;
use vglare::reference;
use vglare::scene::{FindOptions, Ghost, find};
use vglare::series::Bell;

fn main() {
    divan::main();
}

const HD: [u32; 2] = [1920, 1080];

/// Fractions of multiples of an irrational number: spread evenly, and the same every time.
fn part(index: usize, irrational: f64) -> f64 {
    (0.5 + index as f64 * irrational).fract()
}

/// Gaussians of sizes from one to the other, every octave as likely.
fn ghosts(count: usize, [smallest, largest]: [f64; 2]) -> Vec<Ghost> {
    let one = |k: usize| Ghost {
        bell: Bell::Gaussian,
        center: DVec2::new(3.6 * part(k, 0.754_877_666) - 1.8, 2.0 * part(k, 0.569_840_291) - 1.0),
        size: DVec2::splat(smallest * (largest / smallest).powf(part(k, 0.618_033_989))),
        radiance: [part(k, 0.414_213_562), part(k, 0.732_050_808), part(k, 0.236_067_977)],
    };
    (0..count).map(one).collect()
}

/// A dim gradient with a few hundred small, bright discs.
fn night([width, height]: [u32; 2]) -> Vec<[f32; 4]> {
    let row = |j: u32| (0..width).map(move |i| [0.02 + 1e-5 * i as f32, 0.03, 0.02 + 2e-5 * j as f32, 1.0]);
    let mut pixels: Vec<[f32; 4]> = (0..height).flat_map(row).collect();
    for lamp in 0..300 {
        let [x, y] = [(part(lamp, 0.754_877_666), width), (part(lamp, 0.569_840_291), height)]
            .map(|(part, side)| (part * f64::from(side - 8)) as usize);
        let radiance = 20.0 + 500.0 * part(lamp, 0.618_033_989) as f32;
        for (dx, dy) in
            (0..64).map(|k| (k % 8, k / 8)).filter(|(dx, dy)| (2 * dx - 7i32).pow(2) + (2 * dy - 7i32).pow(2) < 50)
        {
            pixels[(y + dy as usize) * width as usize + x + dx as usize] =
                [radiance, 0.9 * radiance, 0.6 * radiance, 1.0];
        }
    }
    pixels
}

#[divan::bench(args = [10, 1000, 100_000], consts = [0, 1], max_time = 2)]
fn plan_of_ghosts<const SIZES: usize>(bencher: Bencher<'_, '_>, count: usize) {
    let sizes = [[0.1, 0.3], [0.03, 0.5]][SIZES];
    let (problem, request) = (Problem::new(ghosts(count, sizes), Frame::full(HD[0], HD[1])), Request::new(1e-3));
    bencher.bench(|| plan(black_box(&problem), &request).unwrap());
}

#[divan::bench(args = [1e-2, 1e-3, 1e-4], max_time = 2)]
fn plan_of_a_grid(bencher: Bencher<'_, '_>, tolerance: f64) {
    let frame = Frame::full(HD[0], HD[1]);
    let request = Request { evaluator: Some(Evaluator::Grid), ..Request::new(tolerance) };
    let problem = Problem::new(ghosts(100, [0.1, 0.3]), frame);
    bencher.bench(|| plan(black_box(&problem), &request).unwrap());
}

#[divan::bench(max_time = 4)]
fn find_lights(bencher: Bencher<'_, '_>) {
    let (pixels, frame) = (night(HD), Frame::full(HD[0], HD[1]));
    bencher.bench(|| find(black_box(&pixels), &frame, [0.2126, 0.7152, 0.0722], &FindOptions::default()));
}

#[divan::bench(max_time = 2)]
fn reference_of_a_thousand_ghosts_at_a_thousand_points(bencher: Bencher<'_, '_>) {
    let ghosts = ghosts(1000, [0.1, 0.3]);
    let points: Vec<DVec2> = ghosts.iter().map(|ghost| ghost.center).collect();
    bencher.bench(|| reference::direct_at(black_box(&ghosts), black_box(&points)));
}

/// Exposure, tone map, sRGB, dither and PNG.
#[divan::bench(args = [ToneMap::None, ToneMap::Agx], max_time = 4)]
fn write_png(bencher: Bencher<'_, '_>, tone_map: ToneMap) {
    let folder = tempfile::tempdir().unwrap();
    let (hdr, png) = (folder.path().join("night.pfm"), folder.path().join("night.png"));
    let side = [960, 540];
    let mut bytes = format!("PF\n{} {}\n-1.0\n", side[0], side[1]).into_bytes();
    bytes.extend(night(side).iter().flat_map(|pixel| pixel[..3].iter().flat_map(|value| value.to_le_bytes())));
    std::fs::write(&hdr, bytes).unwrap();
    let photo = photo::read(&hdr).unwrap();
    let options = WriteOptions { tone_map: Some(tone_map), overwrite: true, ..WriteOptions::default() };
    bencher.bench(|| photo::write(&png, black_box(&photo), &options).unwrap());
}
