//! What Rust and GLSL agree on: shaders echo the structs field by field, and the harmonics are held to f64.

mod uniforms;

use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bytemuck::{Pod, Zeroable as _};

use super::context::{Backend, Device};
use super::harmonics::Harmonics;
use super::layout::{
    Binding, DirectGhost, DoubleGhost, EVALUATOR, FEW_GHOSTS, GHOSTS, HARMONICS_X, Knots, PARTIALS, SpectralGhost,
};
use super::resource::Buffer;
use super::runner::Runner;
use super::shader::{self, Program};

/// Lets one test at a time use GL. Mesa's software renderer looks through what all contexts of a process draw with, and
/// does not lock it (`llvmpipe_flush_resource`, Mesa 22.3): two threads that draw may end the process.
pub(crate) fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs `test` on each backend, each with a thread of its own; no context is a failure.
fn on_each_backend(test: impl Fn(&Rc<Device>) + Sync) {
    let _turn = turn();
    for backend in Backend::ALL {
        std::thread::scope(|scope| {
            let thread = scope.spawn(|| test(&Device::open(&[backend]).expect("these tests need GL")));
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        });
    }
}

/// The declaration in a file of `shaders/` that begins so, to its `};`: the very text that the passes compile.
fn declaration(path: &str, begin: &str) -> String {
    let source = shader::source(path).unwrap();
    let from = source.find(begin).unwrap_or_else(|| panic!("{path} has no {begin:?}"));
    let length = source[from..].find("};").unwrap() + 2;
    source[from..from + length].to_owned()
}

/// A shader's view of a block: what declares it, where it is bound, and its words, floats as their bits.
struct View {
    declarations: Vec<String>,
    uniform: bool,
    binding: Binding,
    words: Vec<String>,
}

impl View {
    /// What a shader sees of `data`, word by word.
    fn echo<T: Pod>(&self, device: &Rc<Device>, data: &[T]) -> Vec<u32> {
        let mut source = self.declarations.join("\n");
        source.push_str("\nlayout(std430, binding = BINDING_PARTIALS) writeonly buffer Echo { uint echo[]; };\n");
        source.push_str("layout(local_size_x = 1) in;\nvoid main() {\n");
        for (index, word) in self.words.iter().enumerate() {
            source.push_str(&format!("    echo[{index}] = {word};\n"));
        }
        source.push_str("}\n");
        let program = Program::compute_from(device, &source).unwrap();
        let input = Buffer::from_slice(device, data).unwrap();
        let echo = Buffer::<u32>::new(device, self.words.len()).unwrap();
        if self.uniform {
            input.bind_uniform(self.binding);
        } else {
            input.bind_storage(self.binding);
        }
        echo.bind_storage(PARTIALS);
        program.dispatch([1, 1, 1]);
        echo.read(self.words.len())
    }
}

/// GLSL that gives each component of a vector as a word.
fn components(vector: &str, count: usize, float: bool) -> Vec<String> {
    let component = |letter: char| {
        let value = format!("{vector}.{letter}");
        if float { format!("floatBitsToUint({value})") } else { value }
    };
    "xyzw".chars().take(count).map(component).collect()
}

/// Two ghosts, as the shader of `path` declares them, by the words that `fields` gives of each: the second shows the
/// stride.
fn ghosts(path: &str, fields: fn(&str) -> Vec<String>) -> View {
    let words = ["ghosts[0]", "ghosts[1]"].map(fields);
    let block = "layout(std430, binding = BINDING_GHOSTS)";
    View {
        declarations: vec![declaration(path, "struct Ghost {"), declaration(path, block)],
        uniform: false,
        binding: GHOSTS,
        words: words.concat(),
    }
}

/// The view of the same ghosts in a uniform block.
fn few_ghosts(path: &str, fields: fn(&str) -> Vec<String>) -> View {
    let block = declaration(path, "layout(std140, binding = BINDING_FEW_GHOSTS)");
    let many = ghosts(path, fields);
    View { declarations: vec![many.declarations[0].clone(), block], uniform: true, binding: FEW_GHOSTS, ..many }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn shaders_read_spectral_ghosts_as_they_are_written() {
    let ghost = |k: u8| {
        let at = |index: u8| f32::from(10 * k + index) + 0.5;
        let (phase, size, weight, pad) = ([7 + u32::from(k), 9], [at(2), at(3)], [at(4), at(5), at(6)], at(7));
        let expected = [phase.to_vec(), bits(&size), bits(&weight), bits(&[pad])].concat();
        (SpectralGhost { phase, size, weight, pad }, expected)
    };
    let ([first, second], [a, b]) = ([ghost(0).0, ghost(1).0], [ghost(0).1, ghost(1).1]);
    let view = ghosts("spectrum.comp", |ghost| {
        [
            components(&format!("{ghost}.phase"), 2, false),
            components(&format!("{ghost}.size"), 2, true),
            components(&format!("{ghost}.weight"), 4, true),
        ]
        .concat()
    });
    on_each_backend(|device| assert_eq!(view.echo(device, &[first, second]), [a.clone(), b.clone()].concat()));
}

#[test]
fn shaders_read_direct_ghosts_as_they_are_written() {
    let ghost = |k: u8| {
        let at = |index: u8| f32::from(10 * k + index) + 0.5;
        let (center, inverse_size, weight) = ([at(0), at(1)], [at(2), at(3)], [at(4), at(5), at(6)]);
        let bell = 0x0300_0005 + u32::from(k);
        let expected = [bits(&center), bits(&inverse_size), bits(&weight), vec![bell]].concat();
        (DirectGhost { center, inverse_size, weight, bell }, expected)
    };
    let ([first, second], [a, b]) = ([ghost(0).0, ghost(1).0], [ghost(0).1, ghost(1).1]);
    let fields = |ghost: &str| {
        let colour = |name: &str| format!("floatBitsToUint({ghost}.{name})");
        [
            components(&format!("{ghost}.center"), 2, true),
            components(&format!("{ghost}.inverse_size"), 2, true),
            vec![colour("red"), colour("green"), colour("blue"), format!("{ghost}.bell")],
        ]
        .concat()
    };
    // A uniform block's buffer has to be as long as the block.
    let few: Vec<DirectGhost> = [first, second].into_iter().chain([DirectGhost::zeroed(); 2046]).collect();
    on_each_backend(|device| {
        let expected = [a.clone(), b.clone()].concat();
        assert_eq!(ghosts("evaluators/direct.glsl", fields).echo(device, &[first, second]), expected);
        assert_eq!(few_ghosts("evaluators/direct.glsl", fields).echo(device, &few), expected);
    });
}

#[test]
fn shaders_read_ghosts_of_64_bits_as_they_are_written() {
    let words = |values: &[f64]| -> Vec<u32> {
        values.iter().flat_map(|value| [value.to_bits() as u32, (value.to_bits() >> 32) as u32]).collect()
    };
    let ghost = |k: u8| {
        let at = |index: u8| f64::from(10 * k + index) + 1e-9;
        let (center, size, weight) = ([at(0), at(1)], [at(2), at(3)], [at(4), at(5), at(6)]);
        let bell = 0x0300_0005 + u32::from(k);
        let expected = [words(&center), words(&size), words(&weight), vec![bell]].concat();
        (DoubleGhost { center, size, weight, bell, pad: 0 }, expected)
    };
    let ([first, second], [a, b]) = ([ghost(0).0, ghost(1).0], [ghost(0).1, ghost(1).1]);
    let fields = |ghost: &str| {
        let halves = |name: &str| ["x", "y"].map(|half| format!("unpackDouble2x32({ghost}.{name}).{half}"));
        let names = ["center.x", "center.y", "size.x", "size.y", "red", "green", "blue"];
        [names.map(halves).concat(), vec![format!("{ghost}.bell")]].concat()
    };
    let few: Vec<DoubleGhost> = [first, second].into_iter().chain([DoubleGhost::zeroed(); 1022]).collect();
    let path = "evaluators/direct_double.glsl";
    on_each_backend(|device| {
        let expected = [a.clone(), b.clone()].concat();
        assert_eq!(ghosts(path, fields).echo(device, &[first, second]), expected);
        assert_eq!(few_ghosts(path, fields).echo(device, &few), expected);
    });
}

#[test]
fn shaders_read_knots_as_they_are_written() {
    let knots = [Knots { start: 1, pitch: 2, nodes: 3, fine: 4 }, Knots { start: 5, pitch: 6, nodes: 7, fine: 8 }];
    let view = View {
        declarations: vec![declaration("shared/knots.glsl", "layout(std140, binding = BINDING_EVALUATOR)")],
        uniform: true,
        binding: EVALUATOR,
        words: ["knots_x", "knots_y"].map(|name| components(name, 4, false)).concat(),
    };
    on_each_backend(|device| assert_eq!(view.echo(device, &knots), [1, 2, 3, 4, 5, 6, 7, 8]));
}

#[test]
fn an_echo_of_other_fields_is_not_what_was_written() {
    let knots = [Knots { start: 1, pitch: 2, nodes: 3, fine: 4 }, Knots { start: 5, pitch: 6, nodes: 7, fine: 8 }];
    let view = View {
        declarations: vec![
            "layout(std140, binding = BINDING_EVALUATOR) uniform Knots { uvec4 knots_y; uvec4 knots_x; };".into(),
        ],
        uniform: true,
        binding: EVALUATOR,
        words: ["knots_x", "knots_y"].map(|name| components(name, 4, false)).concat(),
    };
    on_each_backend(|device| assert_eq!(view.echo(device, &knots), [5, 6, 7, 8, 1, 2, 3, 4]));
}

#[test]
fn a_thread_has_one_device_at_a_time_and_none_that_was_abandoned_is_used() {
    let _turn = turn();
    let run = || {
        let first = Device::open(&[Backend::Egl]).expect("these tests need GL");
        let refusal = Device::open(&Backend::ALL).unwrap_err().to_string();
        assert!(refusal.contains("open on this thread already"), "{refusal}");
        assert!(Device::try_open(Backend::OsMesa).is_err());
        // The first is current still.
        Buffer::from_slice(&first, &[1u32, 2]).unwrap();
        drop(first);
        let second = Device::open(&[Backend::Egl]).unwrap();
        let left = Buffer::from_slice(&second, &[1u32, 2]).unwrap();
        second.abandon();
        assert!(second.is_lost());
        let third = Device::open(&[Backend::OsMesa]).unwrap();
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| left.read(2))).is_err());
        drop(left);
        assert_eq!(Buffer::from_slice(&third, &[3u32, 4]).unwrap().read(2), [3, 4]);
    };
    std::thread::scope(|scope| scope.spawn(run).join()).unwrap_or_else(|panic| std::panic::resume_unwind(panic));
}

/// The largest error of cos and sin of n times each phase, against f64, of the phases as they are.
fn harmonic_error(runner: &Runner, phases: &[u32], degree: u32, step: Option<u32>) -> f64 {
    let mut harmonics = Harmonics::new(runner, HARMONICS_X).unwrap();
    harmonics.fill(runner, phases, degree, step).unwrap();
    let values = harmonics.values();
    let mut worst = 0.0f64;
    for (index, value) in values.chunks_exact(2).enumerate() {
        let (n, phase) = ((index / phases.len()) as u32, phases[index % phases.len()]);
        let turns = |phase: u32| TAU * f64::from(n.wrapping_mul(phase)) / 2f64.powi(32);
        let half = step.map_or(0.0, |step| 0.5 * turns(step));
        let gain = if half > 0.0 { (half / half.sin()).powi(4) } else { 1.0 };
        let (sin, cos) = turns(phase).sin_cos();
        for (got, exact) in value.iter().zip([gain * cos, gain * sin]) {
            assert!(got.is_finite());
            worst = worst.max((f64::from(*got) - exact).abs());
        }
    }
    worst
}

#[test]
fn harmonics_are_as_exact_as_f32_for_every_n() {
    const DEGREE: u32 = 4096;
    // Pixels of a picture, and where quadrants and octants meet.
    let mut phases: Vec<u32> = (0..250u32).map(|k| k.wrapping_mul(0x0103_5b1d)).collect();
    phases.extend((0..16).flat_map(|octant: u32| [octant << 28, (octant << 28).wrapping_sub(1), (octant << 28) + 1]));
    let step = 0x0007_a1b3;
    on_each_backend(|device| {
        let runner = Runner::new(device).unwrap();
        let (plain, prefiltered) =
            (harmonic_error(&runner, &phases, DEGREE, None), harmonic_error(&runner, &phases, DEGREE, Some(step)));
        println!("{}: {plain:.1e}, divided by the spline's response {prefiltered:.1e}", device.info().backend);
        // The polynomials are within 2e-9; the rest is a handful of f32 roundings of values up to 1. It does not grow
        // with n, because n * phase wraps exactly.
        assert!(plain <= 2.5e-7, "{plain:e}");
        // The gain is 1 to (pi/2)^4 = 6.1, a fourth power with the roundings of a fourth power.
        assert!(prefiltered <= 6.1 * 6e-7, "{prefiltered:e}");
    });
}

#[test]
fn positions_keep_their_harmonics_through_their_phases() {
    // From x itself: the phase is rounded to 2^-33 of a turn, and harmonic n sees n times that.
    const DEGREE: u32 = 4096;
    const PERIOD: f64 = 20.0;
    let positions: Vec<f64> = (0..275).map(|k| -3.0 + 6.0 * (f64::from(k) + 0.5) / 275.0).collect();
    let phases: Vec<u32> = positions.iter().map(|&x| crate::series::phase(x, PERIOD)).collect();
    on_each_backend(|device| {
        let runner = Runner::new(device).unwrap();
        let mut harmonics = Harmonics::new(&runner, HARMONICS_X).unwrap();
        harmonics.fill(&runner, &phases, DEGREE, None).unwrap();
        let values = harmonics.values();
        for highest in [64, 256, 1024, 4096usize] {
            let rows = values.chunks_exact(2 * positions.len()).take(highest + 1).enumerate();
            let error = |(n, row): (usize, &[f32])| {
                let one = |(&x, value): (&f64, &[f32])| {
                    let (sin, cos) = (TAU * (n as f64 * x / PERIOD)).sin_cos();
                    (f64::from(value[0]) - cos).abs().max((f64::from(value[1]) - sin).abs())
                };
                positions.iter().zip(row.chunks_exact(2)).map(one).fold(0.0, f64::max)
            };
            let worst = rows.map(error).fold(0.0, f64::max);
            let limit = 2.5e-7 + TAU * highest as f64 * 2f64.powi(-33);
            println!("{}: N = {highest}: {worst:.1e}, {limit:.1e} allowed", device.info().backend);
            assert!(worst <= limit);
        }
    });
}
