//! A job template of the Open Job Description, version jobtemplate-2023-09
//! (<https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas>), as YAML.

use super::Job;
use crate::Result;

/// The task's script: paths are seen from the job's folder, and the rest is the command.
const SCRIPT: &str = "cd \"$1\" && shift && exec \"$@\"";

/// The template. Strings are written as JSON has them, which YAML reads alike.
///
/// # Errors
/// None: whoever makes a [`Job`] has looked for what the format cannot hold.
pub fn text(job: &Job) -> Result<String> {
    let Job { name, words, frames, chunk, needs, folder, is_beside } = job;
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let extensions = if chunk.is_some() { "extensions: [TASK_CHUNKING]\n" } else { "" };
    let kind = if chunk.is_some() { "CHUNK[INT]" } else { "INT" };
    let chunks = chunk.map_or(String::new(), |count| {
        format!("\n          chunks: {{defaultTaskCount: {count}, rangeConstraint: NONCONTIGUOUS}}")
    });
    // A path that is not beside the template has no default there: who submits the job gives it.
    let default = if *is_beside { "\n    default: .".to_owned() } else { format!("\n    # {}", quoted(folder)) };
    let gpu = if needs.gpu { "\n        - {name: amount.worker.gpu, min: 1}" } else { "" };
    let (options, inputs) = words.split_at(words.iter().position(|word| word == "--").unwrap_or(words.len()));
    let frame = "--frames={{Task.Param.Frame}}".to_owned();
    let arguments: String =
        options.iter().chain([&frame]).chain(inputs).map(|word| format!("\n            - {}", quoted(word))).collect();
    Ok(format!(
        r#"# Written by vglare {version}. `openjd run` and farms that read the Open Job Description take it as it is.
specificationVersion: jobtemplate-2023-09
{extensions}name: {name}
parameterDefinitions:
  - name: Folder
    description: What the paths below are seen from.
    type: PATH
    objectType: DIRECTORY
    dataFlow: INOUT{default}
  - name: Vglare
    description: The program, by its name on the workers or by its path.
    type: STRING
    default: vglare
  - name: Frames
    description: Frames, as 1001-1240 or 1,3,7-20:2.
    type: STRING
    default: {frames}
steps:
  - name: Glare
    parameterSpace:
      taskParameterDefinitions:
        - name: Frame
          type: {kind}
          range: "{{{{Param.Frames}}}}"{chunks}
    hostRequirements:
      amounts:
        - {{name: amount.worker.vcpu, min: {cores}}}
        - {{name: amount.worker.memory, min: {memory}}}{gpu}
    script:
      embeddedFiles:
        - name: Run
          type: TEXT
          data: |
            {SCRIPT}
      actions:
        onRun:
          command: sh
          cancelation: {{mode: NOTIFY_THEN_TERMINATE, notifyPeriodInSeconds: 10}}
          args:
            - "{{{{Task.File.Run}}}}"
            - "{{{{Param.Folder}}}}"
            - "{{{{Param.Vglare}}}}"{arguments}
"#,
        version = env!("CARGO_PKG_VERSION"),
        name = quoted(name),
        frames = quoted(&frames.to_string()),
        cores = needs.cores,
        memory = needs.memory,
    ))
}
