//! A batch script for Slurm: an array of tasks, each of which does some of the frames.

use super::Job;
use crate::{Error, Result};

/// The tasks that an array has at most, as Slurm is set where nobody has set it (MaxArraySize 1001).
const MOST_TASKS: usize = 1000;
/// How often a task that fails is put into the queue again.
const RETRIES: u32 = 2;

/// The script.
///
/// # Errors
/// [`Error::Usage`] for more tasks than an array has.
pub fn text(job: &Job) -> Result<String> {
    let Job { name, words, frames, chunk, needs, folder, is_beside: _ } = job;
    let chunk = chunk.unwrap_or_else(|| frames.len().div_ceil(MOST_TASKS));
    let tasks: Vec<String> = frames.chunks(chunk).map(|frames| frames.to_string()).collect();
    if tasks.len() > MOST_TASKS {
        let count = tasks.len();
        return Err(Error::Usage(format!(
            "an array of Slurm has {MOST_TASKS} tasks at most, and --chunk {chunk} makes {count}"
        )));
    }
    let quoted = |word: &str| shlex::try_quote(word).map(|quoted| quoted.into_owned());
    let held = |error: shlex::QuoteError| Error::Usage(format!("a script cannot hold this: {error}"));
    let words = words.iter().map(|word| quoted(word)).collect::<Result<Vec<_>, _>>().map_err(held)?;
    let (options, inputs) = words.split_at(words.iter().position(|word| word == "--").unwrap_or(words.len()));
    Ok(format!(
        r#"#!/bin/sh
# Written by vglare {version}: `sbatch` takes it as it is. VGLARE names another program than the one on the nodes' PATH.
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cores}
#SBATCH --mem={memory}M
{gpu}#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=vglare-%A_%a.log
cd {folder} || exit 2
frames=$(sed -n "$((SLURM_ARRAY_TASK_ID + 1))p" <<'END'
{tasks}
END
)
"${{VGLARE:-vglare}}" {options} --frames="$frames" {inputs}
code=$?
# What failed may succeed elsewhere, and frames that are done are not done again; a command line that is wrong stays so.
if [ "$code" -ne 0 ] && [ "$code" -ne 2 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt {RETRIES} ]; then
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
fi
exit "$code"
"#,
        version = env!("CARGO_PKG_VERSION"),
        name = quoted(name).map_err(held)?,
        last = tasks.len() - 1,
        cores = needs.cores,
        memory = needs.memory,
        gpu = if needs.gpu { "#SBATCH --gpus=1\n" } else { "" },
        folder = quoted(folder).map_err(held)?,
        tasks = tasks.join("\n"),
        options = options.join(" "),
        inputs = inputs.join(" "),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::job::Needs;

    fn script(frames: &str, chunk: Option<usize>) -> Result<String> {
        text(&Job {
            name: "a job".into(),
            words: ["apply", "--output=it's/", "--resume", "--", "in ####.exr"].map(String::from).to_vec(),
            frames: frames.parse().unwrap(),
            chunk,
            needs: Needs { cores: 4, memory: 900, gpu: true },
            folder: "/some where".into(),
            is_beside: true,
        })
    }

    #[test]
    fn tasks_have_all_frames_and_words_are_quoted() {
        let script = script("1001-1010", Some(4)).unwrap();
        for expected in [
            "#SBATCH --array=0-2\n",
            "#SBATCH --job-name='a job'\n",
            "#SBATCH --gpus=1\n",
            "\n1001-1004\n1005-1008\n1009-1010\nEND\n",
            "cd '/some where' ||",
            r#"apply "--output=it's/" --resume --frames="$frames" -- 'in ####.exr'"#,
        ] {
            assert!(script.contains(expected), "{expected} is not in:\n{script}");
        }
    }

    #[test]
    fn an_array_is_no_longer_than_slurm_lets_it_be() {
        assert!(script("1-2500", None).unwrap().contains("#SBATCH --array=0-833\n"));
        assert!(matches!(script("1-2500", Some(2)), Err(Error::Usage(_))));
    }
}
