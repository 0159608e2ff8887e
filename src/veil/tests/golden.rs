//! Sums of fifty digits.

use serde_json::Value;

use super::worst;
use crate::veil::reference::{self, Window};
use crate::veil::{Border, Gaussian, Geometry, Kernel, Mixture, Photo, Plan};

fn number(value: &Value) -> f64 {
    value.as_str().and_then(|text| text.parse().ok()).unwrap_or_else(|| value.as_f64().unwrap_or(f64::NAN))
}

fn rows(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().flat_map(|row| row.as_array().into_iter().flatten().map(number)).collect()
}

/// A small picture through a Gaussian; there every pixel's own light is part of the sum.
#[test]
fn a_picture_through_a_gaussian() {
    let file: Value =
        serde_json::from_str(include_str!("../../../tests/golden/image_veil.json")).expect("a golden file");
    let cases = file["cases"].as_array().expect("cases");
    assert!(!cases.is_empty());
    for case in cases {
        let size = ["width", "height"].map(|side| case[side].as_u64().expect("a size") as usize);
        let image: Vec<f32> = rows(&case["image"]).into_iter().map(|value| value as f32).collect();
        let terms = vec![Gaussian { sigma: number(&case["sigma"]), weight: 1.0 }];
        let kernel = Kernel::from_mixture(Mixture { terms, ..Mixture::default() }).expect("a kernel");
        let geometry = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };
        let photo = Photo::planes([&image; 3], size).expect("a photo");
        let truth = reference::veil(&photo, &geometry, &kernel, Border::None, Window::whole(size));
        for ((truth, golden), own) in truth.iter().zip(rows(&case["direct"])).zip(&image) {
            // The picture's values are rounded to 32 bits here.
            assert!(((truth[0] + f64::from(*own)) / golden - 1.0).abs() < 1e-7);
        }
        let plan = Plan::new(&geometry, &kernel, size, Border::None, 1e-4).expect("a plan");
        let veil = plan.evaluate(&photo).expect("a veil");
        assert!(worst(&veil, &photo, &geometry, &kernel, Border::None, Window::whole(size)).0 < plan.predicted().bound);
    }
}
