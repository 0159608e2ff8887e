//! Reports, and the schema that says what they hold.

use serde_json::Value;

use super::Workplace;

/// What is wrong with a report by the definition of this name in docs/report.schema.json; empty where it is as it says.
fn faults(definition: &str, report: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(include_str!("../../../docs/report.schema.json")).unwrap();
    let schema = serde_json::json!({ "$ref": format!("#/$defs/{definition}"), "$defs": schema["$defs"] });
    let validator = jsonschema::validator_for(&schema).unwrap();
    validator.iter_errors(report).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

fn reported(place: &Workplace, options: &[&str]) -> Value {
    let arguments: Vec<&str> = ["apply", "--force", "--report", "report.json"].iter().chain(options).copied().collect();
    place.vglare(&arguments).succeeded();
    serde_json::from_slice(&std::fs::read(place.path("report.json")).unwrap()).unwrap()
}

#[test]
fn reports_of_all_kinds_hold_what_their_schema_says() {
    let place = Workplace::new();
    place.photo("night.exr");
    place.photo("s.1.exr");
    place.photo("s.2.exr");
    let one = ["night.exr", "-o", "out.exr"];
    let kinds: [&[&str]; 6] = [
        &["--veil", "cie", "--fov", "50", "--luminance", "100", "--each-pixel"],
        &["--sources", "lights", "--lens", "double-gauss", "--evaluator", "grid"],
        &["--lens", "double-gauss", "--coating", "none", "--tolerance", "1e-2"],
        &["--strength", "0"],
        &["--sources", "lights", "--evaluator", "local", "--veil", "gaussian", "--width", "0.1", "--scatter", "0.1"],
        &["--lens", "none", "--veil", "camera", "--recover", "3"],
    ];
    for kind in kinds {
        let report = reported(&place, &[&one[..], kind].concat());
        assert_eq!(faults("frame", &report), Vec::<String>::new(), "{kind:?}");
        let words: Vec<&str> =
            report["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        assert!(words.ends_with(kind), "{words:?}");
        assert_eq!(report["input"]["blake3"].as_str().map(str::len), Some(64));
    }
    let report = reported(&place, &["s.%d.exr", "-o", "out/"]);
    assert_eq!(faults("sequence", &report), Vec::<String>::new());
    assert_eq!(report["frames"].as_array().unwrap().len(), 2);
}

/// The schema tells a report from one with a key more, a key less, or a word for a number.
#[test]
fn the_schema_is_held_to_the_key() {
    let place = Workplace::new();
    place.photo("night.exr");
    let report = reported(&place, &["night.exr", "-o", "out.exr"]);
    let with = |change: &dyn Fn(&mut Value)| {
        let mut changed = report.clone();
        change(&mut changed);
        faults("frame", &changed)
    };
    assert!(with(&|_| ()).is_empty());
    assert!(!with(&|report| report["scene"]["more"] = 1.into()).is_empty());
    assert!(!with(&|report| drop(report["error"].as_object_mut().unwrap().remove("measured"))).is_empty());
    assert!(!with(&|report| report["error"]["measured"] = "small".into()).is_empty());
    assert!(!with(&|report| report["plan"]["evaluator"] = "guess".into()).is_empty());
}
