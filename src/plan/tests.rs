//! What only the plan's own parts can show: each bound against what it bounds.

use std::f64::consts::PI;

use super::amplitudes::{self, Amplitudes};
use super::candidate::Survey;
use super::*;
use crate::chance::Chance;
use crate::frame::Frame;
use crate::reference;
use crate::series::moments::Cells;
use crate::series::{Bell, Modes};

fn plan(ghosts: &[Ghost], frame: Frame, request: &Request) -> Result<Plan> {
    super::plan(&Problem::new(ghosts, frame), request)
}

fn ghost(center: [f64; 2], size: [f64; 2]) -> Ghost {
    Ghost { bell: Bell::Gaussian, center: center.into(), size: size.into(), radiance: [1.0; 3] }
}

#[test]
fn the_truncation_bound_is_reached_at_the_centre_of_a_ghost() {
    // One ghost on a pixel's centre: all that is left out has one sign there, so the bound is the error.
    let ghosts = [ghost([0.0, 0.0], [0.3, 0.2])];
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let request = Request { evaluator: Some(Evaluator::Rows), ..Request::new(tolerance) };
        let plan = plan(&ghosts, Frame::full(33, 19), &request).unwrap();
        let highest = [200, 200];
        let rectangle = vec![highest[1] + 1; highest[0] as usize + 1];
        let whole = reference::series(&ghosts, plan.period(), &rectangle, DVec2::ZERO)[0];
        let cut = reference::series(&ghosts, plan.period(), plan.counts(), DVec2::ZERO)[0];
        let ratio = (whole - cut) / plan.predicted.truncation;
        assert!((0.999..1.000_001).contains(&ratio), "{tolerance:e}: {ratio}");
    }
}

#[test]
fn the_interpolation_bound_holds_for_a_lattice_evaluated_in_f64() {
    let ghosts = [ghost([0.1, 0.0], [0.3, 0.2]), ghost([-0.7, 0.3], [0.5, 0.4])];
    for tolerance in [1e-1, 1e-2, 1e-3] {
        let frame = Frame::full(160, 90);
        let request = Request { evaluator: Some(Evaluator::Grid), ..Request::new(tolerance) };
        let plan = plan(&ghosts, frame, &request).unwrap();
        let lattice = plan.lattice().unwrap();
        // A row through the ghosts: along x the spline meets cos of n x and sin of n x, one harmonic after the other.
        let theta = 2.0 * PI * lattice.step.x / plan.period().x;
        let field = |x: f64, gained: bool| -> f64 {
            let one = |ghost: &Ghost| {
                let Modes::Product(factor) = ghost.bell.shape().modes() else { unreachable!("a Gaussian") };
                let coefficients = factor.coefficients(plan.degree()[0], ghost.size.x / plan.period().x);
                let term = |n: u32| {
                    let half = 0.5 * f64::from(n) * theta;
                    let gain = if gained && n > 0 { (half / half.sin()).powi(4) } else { 1.0 };
                    let weight = if n == 0 { 1.0 } else { 2.0 };
                    gain * weight
                        * coefficients[n as usize][0]
                        * (2.0 * PI * f64::from(n) * (x - ghost.center.x) / plan.period().x).cos()
                };
                (0..=plan.degree()[0]).map(term).sum::<f64>()
            };
            ghosts.iter().map(one).sum()
        };
        let mut worst = 0.0f64;
        for i in 0..160 {
            let x = frame.x(f64::from(i));
            let place = (x - frame.x(0.0)) / lattice.step.x;
            let (cell, t) = (place.floor(), place.fract());
            let node = |k: f64| field(frame.x(0.0) + (cell + k) * lattice.step.x, true);
            let u = 1.0 - t;
            let weights = [u.powi(3), 4.0 - 3.0 * t * t * (2.0 - t), 4.0 - 3.0 * u * u * (2.0 - u), t.powi(3)];
            let value: f64 = weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(w, k)| w / 6.0 * node(k)).sum();
            worst = worst.max((value - field(x, false)).abs());
        }
        assert!(worst > 0.0 && worst <= lattice.error, "{tolerance:e}: {worst:e} of {:e}", lattice.error);
    }
}

#[test]
fn groups_hold_every_kept_ghost_once_and_sizes_within_half_an_octave() {
    let mut ghosts = Vec::new();
    for k in 0..60 {
        let size = 0.05 * 1.07f64.powi(k);
        ghosts.push(ghost([0.01 * f64::from(k), 0.0], [size, 0.3]));
    }
    let plan = plan(&ghosts, Frame::full(64, 36), &Request::new(1e-2)).unwrap();
    let mut members: Vec<u32> = plan.groups().flat_map(|group| group.members.iter().copied()).collect();
    members.sort_unstable();
    assert!(members.windows(2).all(|pair| pair[0] < pair[1]), "no ghost twice");
    assert_eq!(members.len() + plan.dropped, ghosts.len());
    for group in plan.groups() {
        let sizes = group.members.iter().map(|&index| ghosts[index as usize].size.x);
        let (low, high) = sizes.fold((f64::INFINITY, 0.0f64), |(low, high), size| (low.min(size), high.max(size)));
        assert!(high / low <= 2f64.sqrt() * (1.0 + 1e-12), "{low} to {high}");
        assert_eq!(group.smallest.x, low);
    }
}

#[test]
fn the_direct_sum_knows_how_far_f32_shifts_a_small_bell() {
    let request = |ghosts: &[Ghost]| {
        let request = Request { evaluator: Some(Evaluator::Direct), ..Request::new(0.5) };
        plan(ghosts, Frame::full(65, 37), &request).unwrap().predicted.single()
    };
    let frame = Frame::full(65, 37);
    let pixel = frame.position(60.0, 3.0).to_array();
    let (middle, aside) = (request(&[ghost([0.0, 0.0], [1e-4; 2])]), request(&[ghost(pixel, [1e-4; 2])]));
    assert!(middle < 1e-6 && aside > 1e-3, "{middle:e} {aside:e}");
}

#[test]
fn a_given_oversampling_is_taken_and_its_bound_falls_with_the_fourth_power() {
    let ghosts = [ghost([0.1, 0.0], [0.3, 0.2])];
    let of = |nodes: f64| {
        let request = Request {
            evaluator: Some(Evaluator::Grid),
            period: Some(DVec2::new(6.0, 5.0)),
            degree: Some([24, 30]),
            oversampling: Some(nodes),
            ..Request::new(1e-3)
        };
        plan(&ghosts, Frame::full(160, 90), &request)
    };
    let [coarse, fine] = [4.0, 8.0].map(|nodes| of(nodes).unwrap());
    assert_eq!(coarse.lattice().unwrap().oversampling, DVec2::splat(4.0));
    assert_eq!(fine.lattice().unwrap().step * 2.0, coarse.lattice().unwrap().step);
    let ratio = coarse.predicted.interpolation / fine.predicted.interpolation;
    assert!((14.0..18.0).contains(&ratio), "{ratio}");
    // A spline needs more than one node a half wave; a lattice can be too large.
    for nodes in [0.0, 1.0, -2.0, f64::NAN, f64::INFINITY, 1000.0] {
        assert!(matches!(of(nodes), Err(Error::Plan(_))), "{nodes}");
    }
}

/// The amplitudes of the first 13 x 9 modes of some ghosts in a period of 8 x 6, in their own units.
fn amplitudes_of(ghosts: &[Ghost]) -> (Amplitudes, Vec<u32>, DVec2) {
    let period = DVec2::new(8.0, 6.0);
    // So wide that none is dropped.
    let request = Request { period: Some(period), ..Request::new(1e-6) };
    let problem = Problem::new(ghosts, Frame::full(320, 36));
    let mut survey = Survey::new(&problem, &request);
    let counts = terms::rectangle(&mut survey.groups, [12, 8]);
    let amplitudes = Amplitudes::new(&problem, &survey.groups, &counts, period, [1.0; 3]);
    (amplitudes, counts, period)
}

#[test]
fn amplitudes_bound_what_is_left_out_and_one_ghost_reaches_them() {
    let bells = [
        Bell::Gaussian,
        Bell::Paraboloid,
        Bell::VonMises(crate::series::VonMises { period: DVec2::new(8.0, 6.0) }),
        Bell::SineGaussian(crate::series::SineGaussian { period: DVec2::new(8.0, 6.0), mean: 0.4 }),
    ];
    let place = |k: usize, irrational: f64, span: f64| span * ((k as f64 + 0.5) * irrational).fract() - 0.5 * span;
    let mixed: Vec<Ghost> = (0..24)
        .map(|k| Ghost {
            bell: bells[k % 4].clone(),
            center: DVec2::new(place(k, 0.754_877_666, 3.6), place(k, 0.569_840_291, 2.0)),
            // Those that bring a table have one size.
            size: if k % 4 == 0 { DVec2::new(0.2 + 0.02 * k as f64, 0.3) } else { DVec2::new(0.4, 0.35) },
            radiance: [1.0, if k % 3 == 0 { -0.5 } else { 0.8 }, place(k, 0.618_033_989, 2.0)],
        })
        .collect();
    for ghosts in [mixed.clone(), mixed[..1].to_vec()] {
        let (amplitudes, all, period) = amplitudes_of(&ghosts);
        let (kept, left) = amplitudes.kept(0.2 * ghosts.len() as f64);
        assert!(kept.len() < all.len() && left > 0.0, "{kept:?}");
        let off = |point: DVec2| {
            let [all, kept] = [&all, &kept].map(|counts| reference::series(&ghosts, period, counts, point));
            (0..3).map(|colour| (all[colour] - kept[colour]).abs()).fold(0.0, f64::max)
        };
        let scattered = (0..400).map(|k| DVec2::new(place(k, 0.754_877_666, 8.0), place(k, 0.569_840_291, 6.0)));
        let worst = scattered.chain(ghosts.iter().map(|ghost| ghost.center)).map(off).fold(0.0, f64::max);
        assert!(worst <= left * (1.0 + 1e-12), "{worst:e} of {left:e}");
        let reached = if ghosts.len() == 1 { 0.999_999 } else { 0.1 };
        assert!(worst >= reached * left, "{worst:e} of {left:e}");
    }
}

#[test]
fn amplitudes_know_which_ghosts_add_up_and_which_cancel() {
    let total = |ghosts: &[Ghost]| {
        let (amplitudes, counts, _) = amplitudes_of(ghosts);
        amplitudes.marginals(&counts)[0].iter().map(|held| held[0]).sum::<f64>()
    };
    let one = ghost([0.3, -0.2], [0.3, 0.3]);
    let alone = total(std::slice::from_ref(&one));
    assert!((total(&vec![one.clone(); 50]) / alone - 50.0).abs() < 1e-9);
    let dark = Ghost { radiance: [-1.0; 3], ..one.clone() };
    assert!(total(&[one.clone(), dark]) < 1e-12 * alone);
    // Half a period apart, every odd harmonic of x cancels.
    let apart = Ghost { center: one.center - DVec2::new(4.0, 0.0), ..one.clone() };
    let (amplitudes, counts, _) = amplitudes_of(&[one, apart]);
    let held = &amplitudes.marginals(&counts)[0];
    assert!(held[1][0] < 1e-12 * held[0][0] && held[2][0] > 0.1 * held[0][0], "{held:?}");
}

#[test]
fn too_many_ghosts_for_their_modes_are_not_looked_at_where_a_device_is_sooner_done() {
    let ghosts = vec![ghost([0.1, 0.1], [0.3, 0.3]); 80_000];
    let problem = Problem::new(ghosts.as_slice(), Frame::full(64, 36));
    let mut survey = Survey::new(&problem, &Request::new(1e-3));
    let counts = terms::rectangle(&mut survey.groups, [12, 8]);
    let worth = |spectrum: f64| {
        let model = CostModel { spectrum, ..CostModel::default() };
        amplitudes::worth_looking(&survey.groups, &counts, DVec2::new(8.0, 4.0), false, &model)
    };
    // Nanoseconds for a term: of a graphics card, and of a renderer in software.
    assert!(!worth(0.05) && worth(8.0));
}

#[test]
fn just_above_the_floor_there_is_a_plan_within_the_tolerance() {
    // Where rounding takes most of the tolerance, what is dropped by the tolerance is much of what is left.
    for seed in 0..3 {
        let mut chance = Chance::new(seed);
        let ghosts: Vec<Ghost> = (0..300)
            .map(|_| {
                let [x, y] = [0, 1].map(|_| chance.between(-1.8, 1.8));
                let size = 0.2 * chance.between(0.0, 1.5).exp();
                Ghost { radiance: [chance.between(-16.0, 0.0).exp(); 3], ..ghost([x, y], [size; 2]) }
            })
            .collect();
        for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
            let at = |tolerance| {
                let request = Request::new(tolerance);
                plan(&ghosts, Frame::full(115, 58), &Request { evaluator: Some(evaluator), ..request })
            };
            let floor = match at(1e-8) {
                Err(Error::ToleranceBelowFloor { floor, .. }) => floor,
                other => panic!("{evaluator}: {other:?}"),
            };
            for above in [1.001, 1.02, 1.1, 1.3, 2.0] {
                let plan = at(above * floor).unwrap_or_else(|error| panic!("{evaluator}, {above} floors: {error}"));
                assert!(plan.predicted.total() <= plan.tolerance, "{evaluator}, {above}: {:?}", plan.predicted);
            }
        }
    }
}

/// cos² of so many rows.
fn smooth_profile(rows: u32) -> Bell {
    let row = |i: u32| {
        let r = f64::from(i) / f64::from(rows - 1);
        [r, (0.5 * PI * r).cos().powi(2)]
    };
    Bell::Profile(Arc::new(crate::series::Profile::new(&(0..rows).map(row).collect::<Vec<_>>()).unwrap()))
}

#[test]
fn planning_a_series_is_given_up_where_it_would_cost_more_than_it_could_save() {
    // A sum of milliseconds, and a bell whose transform takes a sum over thousands of rows at thousands of frequencies.
    let bell = smooth_profile(2000);
    let round = Ghost { bell: bell.clone(), ..ghost([0.0, 0.0], [1.2, 1.2]) };
    let made = plan(&[round], Frame::full(1920, 1080), &Request::new(1e-2)).unwrap();
    assert!(!made.evaluator().is_series(), "{:?}", made.costs);
    assert_eq!(made.refused.len(), 3);
    for refusal in &made.refused {
        assert!(refusal.reason.contains("planning it would cost more than it could save"), "{}", refusal.reason);
    }
}

#[test]
fn what_planning_costs_is_counted_and_stays_a_part_of_the_plan_in_hand() {
    let survey = |ghosts: &[Ghost]| Survey::new(&Problem::new(ghosts, Frame::full(1920, 1080)), &Request::new(1e-2));
    let many: Vec<Ghost> = (0..300)
        .map(|k| Ghost { bell: Bell::Paraboloid, ..ghost([0.0, 0.0], [0.3 + 0.001 * f64::from(k); 2]) })
        .collect();
    let survey = survey(&many);
    survey.effort.beside(10.0);
    let mut groups = survey.groups.clone();
    terms::fewest(&mut groups, DVec2::new(8.0, 6.0), 1.0, &survey.effort).unwrap();
    // 300 sizes of one round bell ask for no transform at all.
    let spent = survey.effort.spent();
    assert!((1e4..3e6).contains(&spent), "{spent}");
    let error = (0..1000).find_map(|_| terms::fewest(&mut groups, DVec2::new(8.0, 6.0), 1.0, &survey.effort).err());
    assert!(matches!(error, Some(Error::Plan(reason)) if reason.contains("more than it could save")));
}

#[test]
fn the_floor_that_is_named_has_a_plan_and_is_the_same_whatever_was_asked() {
    let sharp = Ghost { bell: Bell::CosineSquared, ..ghost([0.3, 0.2], [0.5, 0.5]) };
    let frame = Frame::full(160, 90);
    let at = |tolerance| {
        let request = Request { evaluator: Some(Evaluator::Rows), ..Request::new(tolerance) };
        (plan(std::slice::from_ref(&sharp), frame, &request), request)
    };
    let floors = [1e-7, 3e-7].map(|asked| match at(asked).0 {
        Err(Error::ToleranceBelowFloor { floor, .. }) => floor,
        other => panic!("{asked}: {other:?}"),
    });
    assert_eq!(floors[0], floors[1]);
    let [floor, _] = floors;
    let (plan, request) = at(1.0001 * floor);
    assert!(plan.unwrap().predicted.total() <= request.tolerance);
    let least = plan_at_least(&Problem::new(vec![sharp.clone()], frame), &at(1e-7).1).unwrap();
    assert!((least.tolerance / floor - 1.0).abs() < 1e-3 && floor < 2e-5, "{} {floor}", least.tolerance);
}

#[test]
fn what_a_round_bell_holds_along_an_axis_is_bounded_by_its_envelope() {
    for bell in [Bell::Paraboloid, smooth_profile(20)] {
        let group = |degree: u32| {
            let round = Ghost { bell: bell.clone(), ..ghost([0.0, 0.0], [0.5, 0.4]) };
            let survey = Survey::new(&Problem::new(vec![round], Frame::full(64, 36)), &Request::new(1e-3));
            Group { degree: [degree; 2], ..survey.groups[0].clone() }
        };
        // Few modes are summed, and many bounded.
        let [few, many] = [100, 200].map(|degree| {
            let group = group(degree);
            decay::Decay::new(&group, DVec2::new(6.0, 4.0)).marginals(group.degree)
        });
        for (few, many) in few.iter().zip(&many) {
            for (n, (summed, bounded)) in few.iter().zip(many).enumerate() {
                assert!(*bounded >= *summed, "{bell}, {n}: {bounded:e} for {summed:e}");
            }
            assert!(many[1] < 12.0 * few[1], "{bell}: {} for {}", many[1], few[1]);
        }
    }
}

#[test]
fn modes_of_gathered_gaussians_are_those_of_each_by_itself() {
    let ghosts: Vec<Ghost> = (0..200)
        .map(|k| {
            let [x, y, t] = [0.618, 0.414, 0.732].map(|step| (step * f64::from(k)).fract());
            ghost([3.0 * x - 1.5, 2.0 * y - 1.0], [0.2 + 0.07 * t, 0.15 + 0.0525 * t])
        })
        .collect();
    let problem = Problem::new(&ghosts[..], Frame::full(64, 36));
    let survey = Survey::new(&problem, &Request::new(1e-3));
    let (period, counts) = (DVec2::new(6.0, 4.5), [12, 12, 11, 10, 8, 5, 2]);
    let of = |transform: Transform| {
        let group = |group: &Group| Group { degree: [6, 11], transform, ..group.clone() };
        let groups: Vec<Group> = survey.groups.iter().map(group).collect();
        assert!(groups.iter().all(|group| group.proportional));
        amplitudes::modes(&problem, &groups, &counts, period, survey.weighed.scale)
    };
    let cells = Cells { counts: [9, 14], orders: [14, 14] };
    let (each, gathered) =
        (of(Transform::Dispatch), of(Transform::Gather(Gathering { by: Gatherer::Cells(cells), sizes: 10 })));
    let largest = each.as_flattened().as_flattened().iter().fold(0.0f64, |most, term| most.max(term.abs()));
    assert!(each.len() == 60 && largest > 0.01, "{largest}");
    for (each, gathered) in each.as_flattened().as_flattened().iter().zip(gathered.as_flattened().as_flattened()) {
        assert!((each - gathered).abs() < 1e-6 * largest, "{each:e} {gathered:e} of {largest:e}");
    }
}

#[test]
fn what_is_cheap_to_plan_is_planned() {
    // A bell of seventy sizes has seventy tables of coefficients, each of them by a short transform: to find out takes less than a
    // hundredth of the time that a series saves.
    let period = DVec2::new(7.0, 4.5);
    for bell in Bell::examples().into_iter().filter(|bell| bell.shape().period().is_some()) {
        let one = |k: u32| {
            let [x, y, t] = [0.618, 0.414, 0.732].map(|step| (step * f64::from(k)).fract());
            let round = ghost([3.2 * x - 1.6, 1.8 * y - 0.9], [0.2 + 0.4 * t, 0.2 + 0.4 * t]);
            Ghost { bell: bell.clone().in_period(period), ..round }
        };
        let ghosts: Vec<Ghost> = (0..70).map(one).collect();
        let plan = plan(&ghosts, Frame::full(480, 270), &Request::new(2e-2)).unwrap();
        assert_eq!(plan.evaluator(), Evaluator::Grid, "{bell}: {:?}", plan.refused);
        assert_eq!(plan.groups().count(), 70);
    }
}

#[test]
fn two_ghosts_cost_more_than_their_bells() {
    // Where they reach, at an eighth of the pixels, they are drawn for less than two loops take to begin and to end.
    let ghosts = [ghost([0.3, 0.2], [0.1, 0.1]), Ghost { bell: Bell::Parabola, ..ghost([-0.6, 0.1], [0.3, 0.3]) }];
    let plan = plan(&ghosts, Frame::full(480, 270), &Request::new(1e-3)).unwrap();
    assert_eq!(plan.evaluator(), Evaluator::Local, "{:?}", plan.costs);
}

#[test]
fn a_periodic_bell_is_weighed_by_the_lobe_that_the_picture_shows() {
    // Its centre may be anywhere, in the picture or periods beyond it.
    let (frame, mut chance) = (Frame::full(96, 54), Chance::new(158));
    let periodic = Bell::examples().into_iter().filter(|bell| bell.shape().period().is_some());
    let bells: Vec<Bell> = periodic.map(|bell| bell.in_period(DVec2::new(6.5, 5.9))).collect();
    assert_eq!(bells.len(), 2);
    for bell in bells.iter().cycle().take(200) {
        let center = [chance.between(-12.0, 12.0), chance.between(-9.0, 9.0)];
        let ghost =
            Ghost { bell: bell.clone(), ..ghost(center, [chance.between(0.08, 0.6), chance.between(0.06, 0.6)]) };
        let at = |i: u32, j: u32| {
            ghost.bell.shape().value(frame.position(f64::from(i), f64::from(j)) - ghost.center, ghost.size)
        };
        let largest = (0..54).flat_map(|j| (0..96).map(move |i| (i, j))).map(|(i, j)| at(i, j)).fold(0.0, f64::max);
        // What no f32 can hold beside its bell's peak is nothing.
        if largest < 1e-29 {
            continue;
        }
        let weighed = weigh::weigh(&Problem::new(std::slice::from_ref(&ghost), frame), 1e-3);
        let [found, ..] = weighed.scale;
        assert!(
            (0.9 * largest..=1.000_001 * largest).contains(&found),
            "{bell} at {center:?}: {found:e} of {largest:e}"
        );
    }
}
