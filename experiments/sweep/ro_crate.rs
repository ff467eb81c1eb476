//! A bundle as a Research Object Crate 1.1: its files, and the run that made the results of the others, as JSON-LD
//! (<https://w3id.org/ro/crate/1.1>).

use serde_json::{Value, json};

use super::collect::{RESULTS, TIMES};
use super::plan::{PLAN, Plan};
use edifice_base::file::media_type;

/// Name of the metadata in a bundle.
pub const METADATA: &str = "ro-crate-metadata.json";

/// The facts of a publication that a bundle does not hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Published {
    /// Day of publication, `YYYY-MM-DD`.
    pub date: String,
    /// Address of the licence of the data and results.
    pub licence: Option<String>,
}

/// A file of the bundle.
pub struct File<'a> {
    /// Name in the bundle.
    pub name: &'a str,
    /// SHA-256, in hexadecimal digits.
    pub sha256: &'a str,
    /// Number of bytes.
    pub bytes: usize,
}

/// The metadata of a bundle of a plan, as a JSON-LD graph.
pub fn metadata(plan: &Plan, files: &[File], published: &Published) -> Value {
    let link = |name: &str| json!({ "@id": address(name) });
    let all: Vec<Value> = files.iter().map(|file| link(file.name)).collect();
    let made = [RESULTS, TIMES];
    let given = files.iter().filter(|file| !made.contains(&file.name));
    let given: Vec<Value> = given.map(|file| link(file.name)).collect();
    let head = &plan.head;
    let about = format!(
        "{} arms on {} instances, {} tasks of the study {}: settings, plan, instances and results",
        head.arms.len(),
        head.instances.len(),
        head.tasks,
        head.study
    );
    let mut root = json!({
        "@id": "./", "@type": "Dataset",
        "name": format!("Sweep of {}", head.study),
        "description": about,
        "datePublished": &published.date,
        "hasPart": all,
        "mentions": { "@id": "#run" },
    });
    let mut graph = vec![json!({
        "@id": METADATA, "@type": "CreativeWork",
        "conformsTo": { "@id": "https://w3id.org/ro/crate/1.1" }, "about": { "@id": "./" },
    })];
    if let Some(licence) = &published.licence {
        root["license"] = json!({ "@id": licence });
        graph.push(json!({ "@id": licence, "@type": "CreativeWork", "name": licence }));
    }
    graph.push(root);
    graph.push(json!({
        "@id": "#run", "@type": "CreateAction", "name": format!("edifice sweep run, {}", head.study),
        "instrument": { "@id": "#edifice" }, "object": given, "result": made.map(link),
    }));
    graph.push(json!({
        "@id": "#edifice", "@type": "SoftwareApplication", "name": "Edifice",
        "version": env!("CARGO_PKG_VERSION"), "identifier": format!("sources:{}", head.program),
    }));
    graph.extend(files.iter().map(|file| {
        json!({
            "@id": address(file.name), "@type": "File", "name": file.name, "description": what(file.name),
            "contentSize": file.bytes.to_string(), "encodingFormat": media_type(file.name), "sha256": file.sha256,
        })
    }));
    json!({
        "@context": ["https://w3id.org/ro/crate/1.1/context", { "sha256": "https://schema.org/sha256" }],
        "@graph": graph,
    })
}

/// The purpose of a file of a bundle, by its name.
fn what(name: &str) -> &'static str {
    match name.split_once('/').map_or(name, |(folder, _)| folder) {
        "sweep.toml" => "Sweep file: what was asked",
        PLAN => "Plan: each task by a hash of its content",
        RESULTS => "Results: one row a task and metric",
        TIMES => "Measured times of the tasks",
        "instances" => "Instance",
        "learn" => "Data to learn from",
        _ => "File that the command of an arm needs",
    }
}

/// A name as a relative address: all but letters, digits and a few signs as `%XX`.
fn address(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~/".contains(&b);
    let byte = |b: u8| match plain(b) {
        true => char::from(b).to_string(),
        false => format!("%{b:02X}"),
    };
    name.bytes().map(byte).collect()
}

/// The day, UTC, as `YYYY-MM-DD`, so many seconds after the beginning of 1970.
pub fn date(seconds: u64) -> String {
    let mut days = seconds / 86_400;
    let is_leap = |y: u64| y.is_multiple_of(4) && (!y.is_multiple_of(100) || y.is_multiple_of(400));
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year:04}-{month:02}-{:02}", days + 1)
}

/// True if a text is a day, `YYYY-MM-DD`.
pub fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let [year, month, day] = parts[..] else {
        return false;
    };
    let within = |part: &str, digits: usize, range: std::ops::RangeInclusive<u32>| {
        let plain = part.len() == digits && part.bytes().all(|b| b.is_ascii_digit());
        plain && part.parse().is_ok_and(|number| range.contains(&number))
    };
    within(year, 4, 1..=9999) && within(month, 2, 1..=12) && within(day, 2, 1..=31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1970-01-01"),
            (951_782_399, "2000-02-28"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_798_761_599, "2026-12-31"),
            (1_798_761_600, "2027-01-01"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(date(seconds), expected);
            assert!(is_date(expected));
        }
        for wrong in [
            "",
            "2026",
            "2026-1-01",
            "2026-13-01",
            "2026-01-00",
            "26-01-01",
            "2026-01-0x",
            "+026-01-01",
        ] {
            assert!(!is_date(wrong), "{wrong}");
        }
    }

    #[test]
    fn addresses_are_escaped() {
        assert_eq!(
            address("instances/0/a b#ü.png"),
            "instances/0/a%20b%23%C3%BC.png"
        );
    }
}
