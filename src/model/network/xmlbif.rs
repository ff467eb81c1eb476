//! Discrete networks in XMLBIF 0.3 (Cozman 1998), as GeNIe, WEKA and pyAgrum read and write it.
//!
//! Variables and definitions come in any order; what is stated twice is refused. In `<TABLE>` the variable of `<FOR>` varies fastest, and the first `<GIVEN>` slowest. Properties, names of networks and
//! comments are skipped. Rows that are off 1 by rounding (less than 1e-3) are normalised.

use quick_xml::Reader;
use quick_xml::escape::escape;
use quick_xml::events::Event;

use super::super::error::ModelError;
use super::{Cpd, Network, Stated, Variable};

/// The content of a `<DEFINITION>`.
#[derive(Default)]
struct Definition {
    variable: Option<String>,
    given: Vec<String>,
    table: Option<Vec<f64>>,
}

impl Network {
    /// Reads a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the byte, and those of [`Network::new`].
    pub fn from_xmlbif(text: &str) -> Result<Self, ModelError> {
        let mut reader = Reader::from_str(text.trim_start_matches('\u{feff}'));
        let mut open: Vec<String> = Vec::new();
        let mut content = String::new();
        let mut variables: Vec<Variable> = Vec::new();
        let mut definition = Definition::default();
        // Variables may come after their definitions.
        let mut definitions = Vec::new();
        loop {
            let at = reader.buffer_position();
            let wrong = |problem: String| ModelError::corrupt(format!("byte {at}"), problem);
            match reader.read_event().map_err(|e| wrong(e.to_string()))? {
                Event::Start(start) => {
                    let name = start.name().as_ref().to_uppercase();
                    if name == "VARIABLE" {
                        variables.push(Variable::new("", &[], 0, &[], Stated::Open));
                    }
                    if name == "DEFINITION" {
                        definition = Definition::default();
                    }
                    open.push(name);
                    content.clear();
                }
                Event::Text(text) => content += &text,
                Event::CData(text) => content += &text,
                Event::GeneralRef(entity) => {
                    let known = resolved(&entity);
                    content +=
                        &known.ok_or_else(|| wrong(format!("`&{};` is unknown", &*entity)))?;
                }
                Event::End(_) => {
                    let name = open.pop().unwrap_or_default();
                    let within = open.last().map_or("", String::as_str);
                    let word = content.trim().to_owned();
                    match (within, name.as_str()) {
                        ("VARIABLE", "NAME") => {
                            if let Some(last) = variables.last_mut() {
                                if !last.name.is_empty() {
                                    return Err(wrong(twice("NAME", &last.name)));
                                }
                                last.name = word;
                            }
                        }
                        ("VARIABLE", "OUTCOME" | "VALUE") => {
                            if let Some(last) = variables.last_mut() {
                                last.categories.push(word);
                            }
                        }
                        ("DEFINITION", "FOR") => {
                            if let Some(before) = definition.variable.replace(word) {
                                return Err(wrong(twice("FOR", &before)));
                            }
                        }
                        ("DEFINITION", "GIVEN") => definition.given.push(word),
                        ("DEFINITION", "TABLE") => {
                            let table = numbers(&word).map_err(&wrong)?;
                            if definition.table.replace(table).is_some() {
                                let of = definition.variable.unwrap_or_default();
                                return Err(wrong(twice("TABLE", &of)));
                            }
                        }
                        (_, "DEFINITION") => {
                            definitions.push((at, std::mem::take(&mut definition)));
                        }
                        _ => {}
                    }
                    content.clear();
                }
                Event::Eof => break,
                _ => {}
            }
        }
        let end = |problem: String| ModelError::corrupt("end", problem);
        if let Some(name) = open.last() {
            return Err(end(format!("the text ends inside <{name}>")));
        }
        for (at, definition) in definitions {
            let wrong = |problem| ModelError::corrupt(format!("byte {at}"), problem);
            define(&mut variables, definition).map_err(wrong)?;
        }
        if let Some(v) = variables.iter().find(|v| v.stated == Stated::Open) {
            return Err(end(format!("`{}` has no <DEFINITION>", v.name)));
        }
        Self::new(variables)
    }

    /// Writes a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Kind`] for a variable without a table.
    pub fn to_xmlbif(&self) -> Result<String, ModelError> {
        let mut out = String::from(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<BIF VERSION=\"0.3\">\n<NETWORK>\n<NAME>network</NAME>\n",
        );
        for node in &self.nodes {
            out += &format!(
                "<VARIABLE TYPE=\"nature\">\n  <NAME>{}</NAME>\n",
                escape(&node.name)
            );
            for category in &node.categories {
                out += &format!("  <OUTCOME>{}</OUTCOME>\n", escape(category));
            }
            out += "</VARIABLE>\n";
        }
        for node in &self.nodes {
            let Cpd::Table(table) = &node.cpd else {
                return Err(ModelError::Kind {
                    column: node.name.clone(),
                    got: "without a table",
                    expected: "discrete with a table",
                });
            };
            out += &format!("<DEFINITION>\n  <FOR>{}</FOR>\n", escape(&node.name));
            for &parent in &node.discrete {
                out += &format!("  <GIVEN>{}</GIVEN>\n", escape(&self.nodes[parent].name));
            }
            let numbers: Vec<String> = table.iter().map(f64::to_string).collect();
            out += &format!("  <TABLE>{}</TABLE>\n</DEFINITION>\n", numbers.join(" "));
        }
        Ok(out + "</NETWORK>\n</BIF>\n")
    }
}

/// The text of an entity.
fn resolved(entity: &str) -> Option<String> {
    if let Some(known) = quick_xml::escape::resolve_predefined_entity(entity) {
        return Some(known.to_owned());
    }
    let number = entity.strip_prefix('#')?;
    let code = match number.strip_prefix('x') {
        Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16),
        None => number.parse(),
    };
    char::from_u32(code.ok()?).map(String::from)
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| {
        let value = word
            .parse()
            .ok()
            .filter(|v: &f64| v.is_finite() && *v >= 0.0);
        value.ok_or_else(|| format!("`{word}` is no probability"))
    };
    text.split_whitespace().map(number).collect()
}

/// The problem of an element that stands twice.
fn twice(element: &str, of: &str) -> String {
    format!("a second <{element}> for `{of}`")
}

/// Gives a variable its parents and its table.
fn define(variables: &mut [Variable], definition: Definition) -> Result<(), String> {
    let (given, variable) = (definition.given, definition.variable.unwrap_or_default());
    let mut table = definition.table.unwrap_or_default();
    let find = |name: &String| variables.iter().position(|v| v.name == *name);
    let own =
        find(&variable).ok_or_else(|| format!("<FOR> names `{variable}`, which is no variable"))?;
    if variables[own].stated != Stated::Open {
        return Err(format!("`{variable}` is defined twice"));
    }
    let k = variables[own].categories.len();
    let mut cells = Some(k);
    for parent in &given {
        let place = find(parent)
            .ok_or_else(|| format!("<GIVEN> names `{parent}`, which is no variable"))?;
        let size = variables[place].categories.len();
        cells = cells.and_then(|n| n.checked_mul(size));
    }
    if k == 0 || cells != Some(table.len()) {
        return Err(format!(
            "<TABLE> of `{variable}` has {} numbers",
            table.len()
        ));
    }
    for row in table.chunks_mut(k) {
        let sum: f64 = row.iter().sum();
        if (sum - 1.0).abs() > 1e-3 {
            return Err(format!("probabilities of `{variable}` sum to {sum}, not 1"));
        }
        if (sum - 1.0).abs() >= 1e-9 {
            row.iter_mut().for_each(|p| *p /= sum);
        }
    }
    variables[own].parents = given;
    variables[own].stated = Stated::Table(table);
    Ok(())
}
