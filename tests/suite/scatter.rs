//! Veils by the device: the CPU's twins, held to the same bound by the definition.

use vglare::renderer::Scatter;
use vglare::veil::reference::{self, Window};
use vglare::veil::{BadSources, Border, FLOOR, Gaussian, Geometry, Kernel, Method, Mixture, Photo, Plan, Veil};

use super::support::scenes::Chance;
use super::support::{long, on_device};
use vglare::gpu::Backend;

const FLAT: Geometry = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };

/// Runs `test` on each backend, with what sums veils there.
fn on_each_backend(test: impl Fn(&mut Scatter) + Sync) {
    for backend in Backend::ALL {
        on_device(backend, |device| test(&mut Scatter::new(device).expect("what sums veils")));
    }
}

/// Noise, with or without black parts, and some lights that are up to 10^`decades` times as bright; RGB, each colour by itself.
fn photo(chance: &mut Chance, [width, height]: [usize; 2], lights: usize, decades: f64) -> Vec<f32> {
    let black = chance.below(2) == 0;
    let noise = |chance: &mut Chance| if black { 0.0 } else { chance.between(0.0, 1.0).powi(6) as f32 };
    let mut values: Vec<f32> = (0..3 * width * height).map(|_| noise(chance)).collect();
    for _ in 0..lights {
        let at = chance.below((width * height) as u64) as usize;
        values[3 * at..][..3].fill_with(|| 10f64.powf(chance.between(0.0, decades)) as f32);
    }
    values
}

/// Widths from a part of a pixel to beyond the picture.
fn mixture(chance: &mut Chance) -> Kernel {
    let terms = 1 + chance.below(6);
    let term =
        |_| Gaussian { sigma: 10f64.powf(chance.between(-0.4, 2.5)), weight: 10f64.powf(chance.between(-4.0, 1.0)) };
    let terms = (0..terms).map(term).collect();
    let [constant, quadratic] = [1e-5, 1e-9].map(|most| most * chance.between(0.0, 1.0));
    Kernel::from_mixture(Mixture { terms, constant, quadratic }).expect("a kernel")
}

/// Stiles and Holladay's 10 / θ² from half a degree to 30, as a mixture that is within a hundredth of it.
fn stiles_holladay() -> Kernel {
    let terms = [
        [0.559575, 21.6889],
        [1.09122, 5.55952],
        [2.10813, 1.47432],
        [4.05497, 0.399232],
        [8.0148, 0.11422],
        [20.4981, 0.0318955],
    ];
    let terms = terms.map(|[sigma, weight]| Gaussian { sigma, weight: 10.0 * weight }).to_vec();
    Kernel::from_mixture(Mixture { terms, ..Mixture::default() }).expect("a kernel")
}

/// What a sum by the CPU and by the device can differ in where both are right, relative to the local veil: their roundings, and what
/// remains of a pixel's own light, a twentieth of the tolerance each.
fn apart(plan: &Plan, tolerance: f64, veil: &Veil) -> f64 {
    let of_roundings = veil.certified[0] - plan.predicted().bound + 2.0 * plan.predicted().rounding;
    of_roundings + 0.1 * tolerance
}

/// A photo, its plan, and its veil by the CPU and, at some pixels, by the definition.
struct Case {
    name: String,
    values: Vec<f32>,
    size: [usize; 2],
    tolerance: f64,
    plan: Plan,
    cpu: Veil,
    window: Window,
    truth: Vec<[f64; 3]>,
}

impl Case {
    /// None where the veil is not planned by lattices on a plane.
    fn new(
        (geometry, kernel): (Geometry, &Kernel),
        (values, size): (Vec<f32>, [usize; 2]),
        border: Border,
        tolerance: f64,
    ) -> Option<Self> {
        const MOST: usize = 20;
        let plan = Plan::new(&geometry, kernel, size, border, tolerance).expect("a plan");
        if plan.method() != Method::Pyramid {
            return None;
        }
        let photo = Photo::rgb(&values, size).expect("a photo");
        let cpu = plan.evaluate(&photo).expect("a veil");
        let window = Window { first: [0, 0], size: size.map(|side| side.min(MOST)) };
        let truth = reference::veil(&photo, &geometry, kernel, border, window);
        let name = format!("{border:?} {tolerance:.1e} {:?}", kernel.mixture());
        Some(Self { name, values, size, tolerance, plan, cpu, window, truth })
    }

    /// Holds the device's veil to the definition, and to the CPU's at all pixels. Returns the largest difference from the
    /// definition over its bound, and that from the twin over what they may differ in.
    fn held(&self, scatter: &mut Scatter) -> [f64; 2] {
        let photo = Photo::rgb(&self.values, self.size).expect("a photo");
        let gl = scatter.evaluate(&self.plan, &photo).expect("a veil");
        assert_eq!(self.cpu.bad, gl.bad, "{}", self.name);
        let apart = apart(&self.plan, self.tolerance, &gl);
        let mut worst = [0.0f64; 2];
        let mut take = |found: f32, wanted: f64, floor: f64, bound: f64, at: usize, which: usize| {
            let found = f64::from(found);
            let error = if found == wanted { 0.0 } else { (found - wanted).abs() / wanted.max(floor) };
            assert!(
                error <= bound,
                "{} {:?}: {found:e} for {wanted:e} at {at}: {error:e} > {bound:e}, {:?}",
                self.name,
                self.size,
                self.plan.predicted()
            );
            worst[which] = worst[which].max(error / bound);
        };
        for channel in 0..3 {
            let (cpu, plane) = (&self.cpu.planes[channel], &gl.planes[channel]);
            let floor = FLOOR * f64::from(cpu.iter().copied().fold(0.0, f32::max));
            for (pixel, (cpu, gl)) in cpu.iter().zip(plane).enumerate() {
                take(*gl, f64::from(*cpu), floor, apart, pixel, 1);
            }
            for (index, truth) in self.truth.iter().enumerate() {
                let pixel = index / self.window.size[0] * self.size[0] + index % self.window.size[0];
                take(plane[pixel], truth[channel], floor, gl.certified[channel], pixel, 0);
            }
        }
        worst
    }
}

#[test]
fn twins_are_equal_and_hold_the_bound() {
    let (mut chance, count) = (Chance::new(21), if long() { 300 } else { 10 });
    let one = |_| {
        let size = [1 + chance.below(130) as usize, 1 + chance.below(90) as usize];
        let (kernel, pitch) = if chance.below(3) == 0 {
            (stiles_holladay(), 10f64.powf(chance.between(-1.3, -0.3)))
        } else {
            (mixture(&mut chance), 1.0)
        };
        let geometry = Geometry::Planar { pitch, solid_angle: pitch * pitch };
        let border = [Border::None, Border::None, Border::Mirror, Border::Extend][chance.below(4) as usize];
        let tolerance = 10f64.powf(chance.between(-3.5, -2.0));
        let lights = chance.below(7) as usize;
        let values = photo(&mut chance, size, lights, 8.0);
        Case::new((geometry, &kernel), (values, size), border, tolerance)
    };
    let cases: Vec<Case> = (0..count).filter_map(one).collect();
    assert!(2 * cases.len() > count, "{} of {count}", cases.len());
    on_each_backend(|scatter| {
        let mut worst = [0.0f64; 2];
        for held in cases.iter().map(|case| case.held(scatter)) {
            worst = [0, 1].map(|which| worst[which].max(held[which]));
        }
        println!("{:.2} of the bound, {:.3} of what twins may differ in", worst[0], worst[1]);
        // As long as it is sums that are compared, they are not exactly alike.
        assert!(worst[1] > 0.0);
    });
}

fn gaussian(sigma: f64) -> Kernel {
    let term = Gaussian { sigma, weight: 1.0 / (sigma * sigma) };
    Kernel::from_mixture(Mixture { terms: vec![term], ..Mixture::default() }).expect("a kernel")
}

/// One row, one column, one pixel, and sides about the pitch of lattices.
#[test]
fn any_size_and_any_width() {
    let mut chance = Chance::new(5);
    let mut cases = Vec::new();
    for size in [[1, 1], [1, 77], [300, 1], [2, 2], [65, 64], [33, 3]] {
        for sigma in [0.4, 3.0, 60.0] {
            for border in [Border::None, Border::Extend] {
                let values = photo(&mut chance, size, 2, 6.0);
                cases.extend(Case::new((FLAT, &gaussian(sigma)), (values, size), border, 1e-3));
            }
        }
    }
    assert!(cases.len() > 18, "{}", cases.len());
    on_each_backend(|scatter| {
        for case in &cases {
            case.held(scatter);
        }
    });
}

/// From the smallest floats, which shaders may take as 0, to the largest.
#[test]
fn radiances_may_be_tiny_or_huge() {
    let size = [61, 44];
    let geometry = Geometry::Planar { pitch: 0.3, solid_angle: 1e-4 };
    let kernel = stiles_holladay();
    let values: Vec<f32> = photo(&mut Chance::new(4), size, 3, 8.0).into_iter().map(|value| value.min(1e8)).collect();
    let scaled = |factor: f32| values.iter().map(|value| value * factor).collect();
    let cases = [1e-38f32, 1e-30, 1.0, 3e30, 0.0]
        .map(|factor| Case::new((geometry, &kernel), (scaled(factor), size), Border::None, 5e-3).expect("lattices"));
    on_each_backend(|scatter| {
        for case in &cases {
            case.held(scatter);
        }
        let [.., Case { plan, values, .. }] = &cases;
        let black = scatter.evaluate(plan, &Photo::rgb(values, size).expect("a photo")).expect("a veil");
        assert!(black.planes.iter().flatten().all(|value| value.to_bits() == 0));
        assert_eq!((black.dark, black.lonely), ([0; 3], [0; 3]));
    });
}

#[test]
fn bad_pixels_are_counted_and_harm_no_other() {
    let size = [40, 26];
    let mut values = photo(&mut Chance::new(8), size, 2, 3.0);
    let (mut clean, bad) = (values.clone(), [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -2.0, -0.0]);
    for (index, bad) in bad.into_iter().enumerate() {
        values[3 * (100 + 7 * index) + 1] = bad;
        clean[3 * (100 + 7 * index) + 1] = 0.0;
    }
    let geometry = Geometry::Planar { pitch: 0.3, solid_angle: 0.09 };
    let plan = Plan::new(&geometry, &stiles_holladay(), size, Border::None, 5e-3).expect("a plan");
    on_each_backend(|scatter| {
        let [veil, clean] = [&values, &clean]
            .map(|values| scatter.evaluate(&plan, &Photo::rgb(values, size).expect("a photo")).expect("a veil"));
        assert_eq!(veil.planes, clean.planes);
        assert_eq!(veil.bad, BadSources { undefined: [0, 1, 0], infinite: [0, 2, 0], negative: [0, 1, 0] });
    });
}

/// Stars so far apart that the veil of each is far below what rounding leaves of its own light.
#[test]
fn lonely_pixels_are_mended() {
    let (mut chance, size) = (Chance::new(9), [90, 60]);
    let mut values = vec![0.0; 3 * size[0] * size[1]];
    for y in (0..size[1]).step_by(2) {
        for x in (0..size[0]).step_by(2) {
            values[3 * (y * size[0] + x)] = 10f64.powf(chance.between(-4.0, 4.0)) as f32;
        }
    }
    let narrow = [(gaussian(0.35), 1e-4)];
    let wide = [2e-4, 1e-3, 5e-3]
        .into_iter()
        .flat_map(|tolerance| [gaussian(4.0), stiles_holladay()].map(|kernel| (kernel, tolerance)));
    let case = |(kernel, tolerance): (Kernel, f64)| {
        Case::new((FLAT, &kernel), (values.clone(), size), Border::None, tolerance)
    };
    let cases: Vec<Case> = narrow.into_iter().chain(wide).filter_map(case).collect();
    assert!(cases.iter().any(|case| !case.plan.predicted().lattices.is_empty()), "lattices are mended by another way");
    on_each_backend(|scatter| {
        for case in &cases {
            case.held(scatter);
        }
        let narrow = &cases[0];
        let photo = Photo::rgb(&narrow.values, size).expect("a photo");
        assert!(scatter.evaluate(&narrow.plan, &photo).expect("a veil").lonely[0] > 100);
    });
}

/// What a device does not sum it refuses, and says why.
#[test]
fn what_a_device_does_not_sum_is_refused() {
    let size = [30, 20];
    let kernel = stiles_holladay();
    let plan = Plan::new(&Geometry::rectilinear(40.0, 30), &kernel, size, Border::None, 2e-2).expect("a plan");
    let term = Gaussian { sigma: 2.0, weight: 1e-30 };
    let dim = Kernel::from_mixture(Mixture { terms: vec![term], ..Mixture::default() }).expect("a kernel");
    let dim = Plan::new(&FLAT, &dim, size, Border::None, 1e-3).expect("a plan");
    let good = Plan::new(&FLAT, &mixture(&mut Chance::new(3)), size, Border::None, 1e-2).expect("a plan");
    assert_eq!(good.method(), Method::Pyramid);
    on_each_backend(|scatter| {
        let values = vec![1.0; 3 * 30 * 20];
        let photo = Photo::rgb(&values, size).expect("a photo");
        for plan in [&plan, &dim] {
            let refused = scatter.check(plan).expect_err("no device sums this").to_string();
            assert!(refused.contains("lattices of a plane") && refused.contains("too dim"), "{refused}");
            assert!(scatter.evaluate(plan, &photo).is_err());
        }
        scatter.check(&good).expect("a device sums this");
        let other = vec![1.0; 3];
        let refused = scatter.evaluate(&good, &Photo::rgb(&other, [1, 1]).expect("a photo")).expect_err("another size");
        assert!(refused.to_string().contains("30 × 20"), "{refused}");
    });
}
