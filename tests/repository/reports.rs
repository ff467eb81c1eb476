//! The kept report holds together: no link leads nowhere, no best-so-far series rises, every artefact has a command that can be
//! typed, and none is of an unoptimized build.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use edifice_experiments::ALL;
use serde_json::Value;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn artefacts(path: &Path) -> serde_json::Map<String, Value> {
    let text = std::fs::read_to_string(path).expect("a file of the report");
    let mut run: Value = serde_json::from_str(&text).expect("JSON");
    match run["artefacts"].take() {
        Value::Object(artefacts) => artefacts,
        other => panic!("{}: {other}", path.display()),
    }
}

/// All kept artefacts, those of real data too: `paper/name`, and what `run.json` and `provenance.json` say of them.
fn kept() -> Vec<(String, Value)> {
    let mut all = kept_in("reports");
    assert!(all.len() > 60, "{}", all.len());
    all.extend(kept_in("reports/real"));
    all
}

/// The kept artefacts of one report.
fn kept_in(report: &str) -> Vec<(String, Value)> {
    let mut all = Vec::new();
    for experiment in ALL {
        let folder = root().join(report).join(experiment.slug);
        let artefacts = artefacts(&folder.join("run.json"));
        let builds = self::artefacts(&folder.join("provenance.json"));
        assert!(artefacts.keys().eq(builds.keys()), "{}", experiment.slug);
        let named = |(name, made): (&String, &Value)| {
            let mut made = made.clone();
            for (key, value) in builds[name].as_object().expect("an object") {
                // What differs from one run to the next stands apart.
                assert!(made[key].is_null(), "{name} has {key} in run.json");
                made[key] = value.clone();
            }
            (format!("{}/{name}", experiment.slug), made)
        };
        all.extend(artefacts.iter().map(named));
    }
    all
}

/// Files of the repository that are pages, as git knows them; without git, none.
fn pages() -> Vec<PathBuf> {
    let output = std::process::Command::new("git")
        .arg("-C")
        .arg(root())
        .args([
            "ls-files",
            "-co",
            "--exclude-standard",
            "*.md",
            "reports/*.html",
        ])
        .output();
    let Ok(output) = output.map_err(|_| ()) else {
        return Vec::new();
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines()
        .map(|line| root().join(line))
        .filter(|p| p.is_file())
        .collect()
}

/// Targets of the links and pictures of a page, those inside code left out.
fn targets(text: &str, is_html: bool) -> Vec<String> {
    if is_html {
        let pieces = text.split("href=\"").chain(text.split("src=\"")).skip(1);
        let cut = pieces
            .filter_map(|p| p.split_once('"'))
            .map(|(t, _)| t.to_owned());
        return cut.filter(|t| !t.contains(['<', '\n'])).collect();
    }
    let mut fenced = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        if fenced {
            continue;
        }
        let outside: Vec<&str> = line.split('`').step_by(2).collect();
        for piece in outside.join("").split("](").skip(1) {
            found.extend(piece.split_once(')').map(|(t, _)| t.to_owned()));
        }
    }
    found
}

/// The name by which a heading is linked.
fn anchor(heading: &str) -> String {
    let heading = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = heading
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn no_link_leads_nowhere() {
    let mut dead = Vec::new();
    let mut count = 0;
    for page in pages() {
        let text = std::fs::read_to_string(&page).expect("text");
        let is_html = page.extension().is_some_and(|e| e == "html");
        for target in targets(&text, is_html) {
            if target.contains("://")
                || target.starts_with("mailto:")
                || target.starts_with("data:")
            {
                continue;
            }
            count += 1;
            let (path, place) = target.split_once('#').unwrap_or((&target, ""));
            let file = match path {
                "" => page.clone(),
                path => page.parent().expect("a folder").join(path),
            };
            let own = || std::fs::read_to_string(&file).unwrap_or_default();
            // A link to what is not kept is dead in a clone even if the file is here.
            let real = page.starts_with(root().join("reports/real")) && path.ends_with(".csv");
            let kept = !real
                && ![".glb", "/benchmark.csv", "/completion.csv"]
                    .iter()
                    .any(|e| path.ends_with(e));
            let there = match (
                file.exists() && kept,
                place,
                file.extension().and_then(|e| e.to_str()),
            ) {
                (false, _, _) => false,
                (true, "", _) => true,
                (true, place, Some("md")) => own()
                    .lines()
                    .any(|l| l.starts_with('#') && anchor(l) == place),
                (true, place, _) => own().contains(&format!("id=\"{place}\"")),
            };
            if !there {
                dead.push(format!("{}: {target}", page.display()));
            }
        }
    }
    println!("{count} links");
    assert!(
        dead.is_empty(),
        "{} dead links:\n{}",
        dead.len(),
        dead.join("\n")
    );
}

#[test]
fn no_lowest_cost_so_far_rises() {
    let path = root().join("reports/facade_grammar/figure_14.csv");
    let text = std::fs::read_to_string(path).expect("kept");
    let mut series: BTreeMap<String, Vec<(u64, f64)>> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let (facade, iteration) = cells[3].split_once('@').expect("facade@iteration");
        if cells[5] == "cost" {
            let key = format!("{} {facade} {}", cells[2], cells[4]);
            let point = (
                iteration.parse().expect("a number"),
                cells[6].parse().expect("a number"),
            );
            series.entry(key).or_default().push(point);
        }
    }
    assert!(series.len() > 8, "{}", series.len());
    for (name, mut points) in series {
        points.sort_by_key(|p| p.0);
        assert!(
            points.windows(2).all(|pair| pair[0].1 >= pair[1].1),
            "{name}: {points:?}"
        );
    }
    // Averages at a time and at the end are of the same runs.
    for (artefact, made) in kept() {
        for comparison in made["comparisons"].as_array().expect("a list") {
            let quantity = comparison["quantity"].as_str().unwrap_or_default();
            if quantity.contains("cost at") && quantity.ends_with("and at the end") {
                let ours = comparison["ours"].as_str().unwrap_or_default();
                let costs: Vec<f64> = ours.split(", ").filter_map(|c| c.parse().ok()).collect();
                assert!(
                    costs.len() == 2 && costs[0] >= costs[1],
                    "{artefact}: {quantity}: {ours}"
                );
            }
        }
    }
}

/// The report is what the README's command makes, and what needs real data stands apart.
#[test]
fn what_is_kept_is_what_the_command_makes() {
    let real = |made: &Value| {
        let data = made["data"].as_object().expect("an object");
        data.keys().any(|name| name.starts_with("DATA/"))
    };
    for (artefact, made) in kept_in("reports") {
        let (slug, name) = artefact.split_once('/').expect("paper/name");
        let command = format!("edifice reproduce {slug} --only {name}");
        assert_eq!(made["command"], command, "{artefact}");
        assert!(!real(&made), "{artefact} is of real data");
    }
    let kept = kept_in("reports/real");
    assert!(kept.len() > 15, "{}", kept.len());
    for (artefact, made) in kept {
        assert!(real(&made), "{artefact} needs no real data");
    }
}

/// True for options of `edifice reproduce` by which this artefact is made.
fn are_options(words: &[&str], artefact: &str) -> bool {
    let only: Vec<&str> = words
        .windows(2)
        .filter(|w| w[0] == "--only")
        .flat_map(|w| w[1].split(','))
        .collect();
    let known = words.chunks(2).all(|pair| match pair {
        ["--data" | "--out" | "--only", value] => !value.starts_with('-'),
        ["--budget", budget] => ["smoke", "default", "paper"].contains(budget),
        ["--seed" | "--threads", number] => number.parse::<u64>().is_ok(),
        _ => false,
    });
    known && (only.is_empty() || only.contains(&artefact))
}

#[test]
fn every_kept_artefact_has_a_command_that_can_be_typed() {
    let mut wrong = Vec::new();
    for (artefact, made) in kept() {
        let (slug, name) = artefact.split_once('/').expect("paper/name");
        let command = made["command"].as_str().unwrap_or_default();
        let words: Vec<&str> = command.split_whitespace().collect();
        let options = match words.as_slice() {
            ["edifice", "reproduce", paper, options @ ..] => {
                *paper == slug && are_options(options, name)
            }
            _ => false,
        };
        let of_paper = ALL.iter().find(|e| e.slug == slug);
        let exists = of_paper.is_some_and(|e| e.artefacts.iter().any(|a| a.name == name));
        if !exists || !options {
            wrong.push(format!("{artefact}: {command}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} commands:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn no_kept_artefact_is_of_an_unoptimized_build() {
    let unoptimized = |(_, made): &(String, Value)| made["machine"]["optimized"] != true;
    let found: Vec<String> = kept()
        .into_iter()
        .filter(unoptimized)
        .map(|(name, _)| name)
        .collect();
    assert!(found.is_empty(), "{found:?}");
}

/// The first page is small: at most 1 MB before its pictures.
#[test]
fn the_first_page_is_small_and_asks_nobody() {
    let page =
        std::fs::read_to_string(Path::new(&root()).join("reports/index.html")).expect("kept");
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    for foreign in ["<script src", "<link", "@import", "url(http"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
}
