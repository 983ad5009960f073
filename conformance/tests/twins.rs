//! Families are complete and their members agree: the same header, the same phases, the same public functions. Reads
//! sources only; needs no GPU and no GPU crate.

#[path = "common/list.rs"]
mod list;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use twinlight_conformance::{Verdict, kernels};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(root().join(path)).map_err(|error| format!("{path}: {error}"))
}

fn verdict(check: Result<(), String>) -> Verdict {
    match check {
        Ok(()) => Verdict::Passed,
        Err(text) => Verdict::Failed(text),
    }
}

/// Stems of the Rust files in a folder.
fn stems(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join(folder)).into_iter().flatten().flatten();
    let stem = |path: PathBuf| {
        let stem = path.file_stem()?.to_str()?.to_owned();
        (path.extension()? == "rs" && stem != "mod").then_some(stem)
    };
    let mut stems: Vec<String> = entries.filter_map(|entry| stem(entry.path())).collect();
    stems.sort();
    stems
}

fn header(stem: &str) -> Vec<String> {
    vec![
        format!("// kernel family: {stem}"),
        format!("// contract core/src/kernels/{stem}.rs"),
        format!("// cpu backend-cpu/src/kernels/{stem}.rs"),
        format!("// gpu backend-gpu/src/kernels/{stem}.wgsl"),
        format!("// oracle conformance/src/oracle/{stem}.rs"),
    ]
}

fn family_is_complete(stem: &str) -> Result<(), String> {
    let cases = format!("conformance/src/kernels/{stem}.rs");
    let want = header(stem);
    let named = want[1..].iter().filter_map(|line| line.split(' ').nth(2));
    for path in named.chain([cases.as_str()]) {
        let text = read(path)?;
        let got: Vec<&str> = text.lines().take(want.len()).collect();
        if got != want {
            return Err(format!("{path}: opens with {got:#?}, want {want:#?}"));
        }
    }
    Ok(())
}

/// `// [n] …` up to the first colon, in order of first mention.
fn phases(text: &str) -> BTreeMap<u32, String> {
    let mut phases = BTreeMap::new();
    for line in text.lines() {
        let Some((number, words)) = line.trim().strip_prefix("// [").and_then(|rest| rest.split_once(']'))
        else {
            continue;
        };
        let Ok(number) = number.parse() else { continue };
        let words = words.trim().split(':').next().unwrap_or("").trim_end_matches('.').to_owned();
        phases.entry(number).or_insert(words);
    }
    phases
}

fn phases_agree(stem: &str) -> Result<(), String> {
    let cpu = phases(&read(&format!("backend-cpu/src/kernels/{stem}.rs"))?);
    let gpu = phases(&read(&format!("backend-gpu/src/kernels/{stem}.wgsl"))?);
    if cpu.is_empty() && gpu.is_empty() {
        return Ok(());
    }
    // Integers may come about on different ways, step by step; floats only on one, so there the words agree too.
    let exact = read(&format!("core/src/kernels/{stem}.rs"))?.contains("Accuracy::Exact");
    let agree = if exact { cpu.keys().eq(gpu.keys()) } else { cpu == gpu };
    if agree { Ok(()) } else { Err(format!("phases of the twins: cpu {cpu:#?}, gpu {gpu:#?}")) }
}

/// Names after `keyword` at the start of a line.
fn names<'a>(text: &'a str, keyword: &str) -> BTreeSet<&'a str> {
    let name = |rest: &'a str| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next();
    text.lines().filter_map(|line| line.strip_prefix(keyword)).filter_map(name).collect()
}

/// Every public function of a shared Rust file has its WGSL twin, except those marked `// host only`.
fn shared_functions(folder: &str, stem: &str) -> Result<(), String> {
    let rust = read(&format!("core/src/{folder}/{stem}.rs"))?;
    let wgsl_path = format!("backend-gpu/src/shared/{stem}.wgsl");
    let wgsl = read(&wgsl_path)?;
    let tests = rust.find("#[cfg(test)]").unwrap_or(rust.len());
    let public = names(&rust[..tests], "pub fn ");
    let twins = names(&wgsl, "fn ");
    let twin_of = |name: &str| {
        RENAMED.iter().find(|(rust, _)| *rust == name).map_or(name.to_owned(), |r| r.1.to_owned())
    };
    let has_twin = |name: &str| twins.contains(twin_of(name).as_str()) || HOST_ONLY.contains(&name);
    let missing: Vec<&&str> = public.iter().filter(|name| !has_twin(name)).collect();
    if missing.is_empty() { Ok(()) } else { Err(format!("{wgsl_path} lacks {missing:?}")) }
}

/// Public functions that only hosts call.
const HOST_ONLY: [&str; 1] = ["to_f64"];

/// Names that WGSL has taken, with what stands in for them.
const RENAMED: [(&str, &str); 1] = [("mix", "mix_bits")];

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    let found = stems("core/src/kernels");
    let known: BTreeSet<String> = kernels::STEMS.map(String::from).into();
    let same = found.iter().cloned().collect::<BTreeSet<_>>() == known;
    let text = format!("core has {found:?}, the suite knows {known:?}");
    list.add("the suite knows every kernel".into(), move || verdict(if same { Ok(()) } else { Err(text) }));
    for stem in found {
        let other = stem.clone();
        list.add(format!("family of {stem} is complete"), move || verdict(family_is_complete(&stem)));
        list.add(format!("phases of {other} agree"), move || verdict(phases_agree(&other)));
    }
    for folder in ["math", "transport"] {
        for stem in stems(&format!("core/src/{folder}")) {
            list.add(format!("{folder}/{stem} has its WGSL twin"), move || {
                verdict(shared_functions(folder, &stem))
            });
        }
    }
    list.add("hard cases name tests that exist".into(), || verdict(hard_cases()));
    list.run()
}

/// Every id of the table has a row, and every test it names exists in the file it names.
fn hard_cases() -> Result<(), String> {
    let table = read("conformance/HARD-CASES.md")?;
    let mut wanted: BTreeSet<String> = BTreeSet::new();
    for (letter, count) in [("G", 14), ("R", 14), ("V", 10), ("T", 10), ("M", 9), ("D", 10)] {
        wanted.extend((1..=count).map(|n| format!("{letter}{n}")));
    }
    wanted.extend((4..=9).map(|n| format!("M{n}")));
    let mut broken = Vec::new();
    for row in table.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [id, _, tests] = cells[..] else { continue };
        if !wanted.remove(id) {
            continue;
        }
        let named: Vec<&str> = tests.split('`').skip(1).step_by(2).collect();
        if named.is_empty() && !tests.starts_with("not yet, because ") {
            broken.push(format!("{id}: neither a test nor a reason"));
        }
        for test in named {
            match test.split_once("::") {
                Some((path, function))
                    if read(path).is_ok_and(|text| {
                        text.contains(&format!("fn {function}(")) || text.contains(&format!("fn {function}<"))
                    }) => {}
                _ => broken.push(format!("{id}: no test {test}")),
            }
        }
    }
    broken.extend(wanted.iter().map(|id| format!("{id}: no row")));
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n")) }
}
