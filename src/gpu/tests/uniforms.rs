//! Uniforms: each field of a block has, in its shader, the words that the field of that name was given here.

use std::ops::RangeInclusive;

use bytemuck::Pod;

use super::{Binding, View, components, declaration, on_each_backend};
use crate::gpu::coefficients::Dispatch;
use crate::gpu::composite::Composite;
use crate::gpu::evaluators::{Direct, RUNS};
use crate::gpu::layout::{DIRECT, PASS};
use crate::gpu::lines::Uniforms as Line;
use crate::gpu::mask::Mask;
use crate::gpu::range::Step;
use crate::gpu::shrink::Axis;
use crate::gpu::veil::{ConvolveUniforms, ExpandUniforms, FinishUniforms, NEAR_ROWS};
use crate::gpu::view::View as Seen;

/// A field's name, and the numbers of the words that it was given.
type Given = (&'static str, RangeInclusive<u8>);

/// Fields of a block as it is declared: type, and name with how many there are of it.
fn fields(block: &str) -> Vec<(String, String)> {
    let inside = &block[block.find('{').unwrap() + 1..block.rfind('}').unwrap()];
    let code: String = inside.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let declared = code.split(';').filter_map(|field| field.trim().split_once(' '));
    declared.map(|(kind, name)| (kind.to_owned(), name.to_owned())).collect()
}

/// GLSL that gives the words of a field, and each of these words where it holds `numbers`.
fn words(kind: &str, name: &str, numbers: &[u8]) -> (Vec<String>, Vec<u32>) {
    let float = ["float", "vec", "mat"].iter().any(|begin| kind.starts_with(begin));
    let name = name.split('[').next().unwrap_or(name);
    let glsl = match kind {
        "float" => vec![format!("floatBitsToUint({name})")],
        "int" | "uint" => vec![format!("uint({name})")],
        "double" => ["x", "y"].map(|half| format!("unpackDouble2x32({name}).{half}")).to_vec(),
        "mat4x3" => (0..4).flat_map(|column| components(&format!("{name}[{column}]"), 3, true)).collect(),
        "mat3" => (0..3).flat_map(|column| components(&format!("{name}[{column}]"), 3, true)).collect(),
        "uvec4" | "ivec4" if numbers.len() > 4 => {
            let plain = (0..numbers.len() / 4).flat_map(|at| components(&format!("{name}[{at}]"), 4, false));
            plain.map(|word| format!("uint({word})")).collect()
        }
        _ => {
            let size = kind.chars().last().and_then(|size| size.to_digit(10)).expect("a vector") as usize;
            let plain = components(name, size, float);
            if float { plain } else { plain.iter().map(|word| format!("uint({word})")).collect() }
        }
    };
    let word = |&number: &u8| if float { f32::from(number).to_bits() } else { number.into() };
    (glsl, numbers.iter().map(word).collect())
}

/// Holds the block of each of these shaders to the names, the order and the kinds of words that `value` has: those that are
/// given, number by number.
fn held<T: Pod + Sync>(paths: &[&str], (block, binding): (&str, Binding), value: T, given: &[Given]) {
    for path in paths {
        let declared = declaration(path, &format!("layout(std140, binding = {block})"));
        let there = fields(&declared);
        let named = |name: &str| there.iter().find(|(_, field)| field.split('[').next() == Some(name));
        for (_, field) in there.iter().filter(|(_, field)| !field.starts_with("pad")) {
            let name = field.split('[').next().unwrap();
            assert!(given.iter().any(|(given, _)| *given == name), "{path}: {name} is not given");
        }
        let (mut glsl, mut expected) = (Vec::new(), Vec::new());
        for (name, numbers) in given {
            let (kind, field) = named(name).unwrap_or_else(|| panic!("{path} has no {name}"));
            let numbers: Vec<u8> = numbers.clone().collect();
            let (words, values) = words(kind, field, &numbers);
            assert_eq!(words.len(), values.len(), "{path}: {name} is a {kind}");
            glsl.extend(words);
            expected.extend(values);
        }
        let view = View { declarations: vec![declared], uniform: true, binding, words: glsl };
        on_each_backend(|device| assert_eq!(view.echo(device, &[value]), expected, "{path}"));
    }
}

/// Four columns of three numbers from the first on.
fn columns(first: u8) -> [[f32; 4]; 4] {
    let number = |at: u8| f32::from(first + at);
    [0, 3, 6, 9].map(|at| [number(at), number(at + 1), number(at + 2), 0.0])
}

const BLOCK: (&str, Binding) = ("BINDING_PASS", PASS);

#[test]
fn shaders_read_the_uniforms_of_the_composite_as_they_are_written() {
    let value = Composite {
        scale: [1.0, 2.0, 3.0, 4.0],
        constant: [5.0, 6.0, 7.0, 8.0],
        light_gain: [9.0, 10.0, 11.0, 12.0],
        luminance: [13.0, 14.0, 15.0, 16.0],
        strength: 17.0,
        flat: 18.0,
        knee: [19.0, 20.0],
        overlay: columns(21),
    };
    let vectors = [("scale", 1..=4), ("constant", 5..=8), ("light_gain", 9..=12), ("luminance", 13..=16)];
    let rest = [("strength", 17..=17), ("flat_span", 18..=18), ("knee", 19..=20), ("overlay_weights", 21..=32)];
    let given = [&vectors[..], &rest].concat();
    held(&["composite.frag"], BLOCK, value, &given);
}

#[test]
fn shaders_read_the_uniforms_of_the_view_as_they_are_written() {
    let value = Seen {
        gamut: [[1.0, 2.0, 3.0, 0.0], [4.0, 5.0, 6.0, 0.0], [7.0, 8.0, 9.0, 0.0]],
        origin: [10.0, 11.0],
        pitch: 12.0,
        rows: 13.0,
        surround: [14.0, 15.0, 16.0],
        gain: 17.0,
        scale: [18.0, 19.0, 20.0],
        strength: 21.0,
        constant: [22.0, 23.0, 24.0],
        flat: 25.0,
        size: [26.0, 27.0],
        corner: [28.0, 29.0],
        wipe: 30.0,
        means: 31,
        coarse: [32.0, 33.0],
        overlay: columns(34),
    };
    let given = [
        ("gamut", 1..=9),
        ("origin", 10..=11),
        ("pitch", 12..=12),
        ("rows", 13..=13),
        ("surround", 14..=16),
        ("gain", 17..=17),
        ("scale", 18..=20),
        ("strength", 21..=21),
        ("constant", 22..=24),
        ("flat_span", 25..=25),
        ("size", 26..=27),
        ("corner", 28..=29),
        ("wipe", 30..=30),
        ("means", 31..=31),
        ("coarse", 32..=33),
        ("overlay_weights", 34..=45),
    ];
    held(&["view.frag"], BLOCK, value, &given);
}

#[test]
fn shaders_read_the_uniforms_of_the_mask_as_they_are_written() {
    let value = Mask {
        weights: [1.0, 2.0, 3.0],
        threshold: 4.0,
        origin: [5.0, 6.0],
        pitch: 7.0,
        rows: 8.0,
        mark: [9.0, 10.0, 11.0],
        most: 12,
        limit: 13.0,
        pad: [0; 3],
    };
    let given = [
        ("weights", 1..=3),
        ("threshold", 4..=4),
        ("origin", 5..=6),
        ("pitch", 7..=7),
        ("rows", 8..=8),
        ("mark", 9..=11),
        ("most", 12..=12),
        ("limit", 13..=13),
    ];
    held(&["mask.frag"], BLOCK, value, &given);
}

#[test]
fn shaders_read_the_uniforms_of_means_ranges_and_lines_as_they_are_written() {
    let axis = Axis { origin: 1.0, pitch: 2.0, end: 3.0, taps: 4, stride: 5, aside: 6, last: 7, pad: 0 };
    let names = ["origin", "pitch", "end", "taps", "stride", "aside", "last"];
    let given: Vec<Given> = (1..).zip(names).map(|(number, name)| (name, number..=number)).collect();
    held(&["shrink.frag"], BLOCK, axis, &given);

    let step = Step { scale: [1.0, 2.0, 3.0, 4.0], size: [5, 6], pad: [0; 2] };
    held(&["range.frag"], BLOCK, step, &[("scale", 1..=4), ("size", 5..=6)]);

    let line = Line { window: [1.0, 2.0, 3.0, 4.0], colour: [5.0, 6.0, 7.0, 8.0] };
    held(&["lines.vert", "lines.frag"], BLOCK, line, &[("window", 1..=4), ("colour", 5..=8)]);
}

#[test]
fn shaders_read_the_uniforms_of_coefficients_as_they_are_written() {
    let value = Dispatch { sample_count: 1, mode_count: 2, turns: 3, first_ghost: 4, gain: 5.0, pad: [0.0; 3] };
    let names = ["sample_count", "mode_count", "turns", "first_ghost", "gain"];
    let given: Vec<Given> = (1..).zip(names).map(|(number, name)| (name, number..=number)).collect();
    held(&["coefficients.comp"], BLOCK, value, &given);
}

#[test]
fn shaders_read_the_uniforms_of_the_direct_sum_as_they_are_written() {
    let value = Direct {
        corner: [1, 2],
        size: [3, 4],
        count: 5,
        pad: 0,
        unit: [6.0, 7.0],
        aspect: [f64::from_bits(9 << 32 | 8), f64::from_bits(11 << 32 | 10)],
        runs: std::array::from_fn(|at| 12 + at as u32),
    };
    let runs = 12..=11 + RUNS as u8;
    let begin = [("corner", 1..=2), ("size", 3..=4), ("ghost_count", 5..=5), ("unit", 6..=7)];
    let block = ("BINDING_DIRECT", DIRECT);
    let of = |aspect: &[Given]| [&begin[..], aspect, &[("runs", runs.clone())]].concat();
    held(&["evaluators/direct.glsl"], block, value, &of(&[("aspect", 8..=11)]));
    held(&["evaluators/direct_double.glsl"], block, value, &of(&[("aspect", 8..=9), ("length_unit", 10..=11)]));
}

#[test]
fn shaders_read_the_uniforms_of_veils_as_they_are_written() {
    let convolve = ConvolveUniforms { first: 1, stride: 2, count: 3, end: 4, aside: 5, pad: [0; 3] };
    let names = ["first", "stride", "count", "end", "aside"];
    let given: Vec<Given> = (1..).zip(names).map(|(number, name)| (name, number..=number)).collect();
    held(&["veil/convolve.frag"], BLOCK, convolve, &given);

    let expand = ExpandUniforms { first: 1, even: 2, odd: 3, end: 4 };
    let given: Vec<Given> =
        (1..).zip(["first", "even", "odd", "end"]).map(|(number, name)| (name, number..=number)).collect();
    held(&["veil/expand.frag"], BLOCK, expand, &given);

    let mut fours = [[0; 4]; NEAR_ROWS];
    fours.as_flattened_mut().iter_mut().zip(24..).for_each(|(four, number)| *four = number);
    let finish = FinishUniforms {
        first: [1, 2],
        size: [3, 4],
        middle: [5.0, 6.0],
        rows: 7,
        pad: 0,
        constant: [8.0, 9.0, 10.0, 11.0],
        across: [12.0, 13.0, 14.0, 15.0],
        down: [16.0, 17.0, 18.0, 19.0],
        square: [20.0, 21.0, 22.0, 23.0],
        fours,
    };
    let given = [
        ("first", 1..=2),
        ("size", 3..=4),
        ("middle", 5..=6),
        ("rows", 7..=7),
        ("constant", 8..=11),
        ("across", 12..=15),
        ("down", 16..=19),
        ("square", 20..=23),
        ("fours", 24..=23 + 4 * NEAR_ROWS as u8),
    ];
    held(&["veil/finish.frag"], BLOCK, finish, &given);
}
