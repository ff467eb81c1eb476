//! Sets of properties: the common ones of the standard, shared by all products of a class, and one of our own.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::step::{Id, Step, exact, global_id, list, quoted};

/// The sets of a building.
pub(super) struct Sets<'a> {
    /// Name of the building.
    name: &'a str,
    /// Products by the word in the name of their common set.
    common: BTreeMap<&'static str, Vec<Id>>,
}

impl<'a> Sets<'a> {
    /// No sets yet of a building of some name.
    pub(super) fn new(name: &'a str) -> Self {
        Self {
            name,
            common: BTreeMap::new(),
        }
    }

    /// Gives a product the common set of a class, such as `Wall`.
    pub(super) fn common(&mut self, class: &'static str, product: Id) {
        self.common.entry(class).or_default().push(product);
    }

    /// Writes the attributes of an object as its set `Edifice`; `kind` and `name` tell it from other objects.
    pub(super) fn own(
        &self,
        step: &mut Step,
        kind: &str,
        name: &str,
        object: Id,
        attributes: &Map<String, Value>,
    ) {
        let mut properties = Vec::new();
        for (key, value) in attributes {
            let value = match value {
                Value::Null => continue,
                Value::Bool(true) => "IFCBOOLEAN(.T.)".to_owned(),
                Value::Bool(false) => "IFCBOOLEAN(.F.)".to_owned(),
                Value::Number(number) => match (number.as_i64(), number.as_f64()) {
                    (Some(whole), _) => format!("IFCINTEGER({whole})"),
                    (None, Some(number)) => format!("IFCREAL({})", exact(number)),
                    (None, None) => continue,
                },
                Value::String(text) => format!("IFCTEXT({})", quoted(text)),
                other => format!("IFCTEXT({})", quoted(&other.to_string())),
            };
            properties.push(single(step, key, &value));
        }
        if !properties.is_empty() {
            self.set(step, &[kind, name], "Edifice", &properties, &[object]);
        }
    }

    /// Writes the common sets.
    pub(super) fn write(&self, step: &mut Step) {
        for (class, products) in &self.common {
            let external = single(step, "IsExternal", "IFCBOOLEAN(.T.)");
            let name = format!("Pset_{class}Common");
            self.set(step, &["all", class], &name, &[external], products);
        }
    }

    fn set(&self, step: &mut Step, owner: &[&str; 2], name: &str, properties: &[Id], of: &[Id]) {
        let id = |kind: &str| global_id(&[self.name, kind, owner[0], owner[1]]);
        let set = step.add(format_args!(
            "IFCPROPERTYSET({},$,{},$,{})",
            id("properties"),
            quoted(name),
            list(properties)
        ));
        step.add(format_args!(
            "IFCRELDEFINESBYPROPERTIES({},$,$,$,{},{set})",
            id("has properties"),
            list(of)
        ));
    }
}

fn single(step: &mut Step, name: &str, value: &str) -> Id {
    let name = quoted(name);
    step.share(format_args!("IFCPROPERTYSINGLEVALUE({name},$,{value},$)"))
}
