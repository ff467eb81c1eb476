//! The edges that a structure may, must and must not have.

use super::super::super::error::ModelError;
use super::super::super::graph::order;
use super::super::super::table::Table;
use super::settings::SearchSettings;

/// Constraints by column.
pub(super) struct Allowed {
    /// `edge[p][c]`: whether p may be a parent of c.
    edge: Vec<Vec<bool>>,
    /// Required parents of every column, ascending.
    pub required: Vec<Vec<usize>>,
}

impl Allowed {
    pub(super) fn new(data: &Table, settings: &SearchSettings) -> Result<Self, ModelError> {
        let names: Vec<String> = data.columns().iter().map(|c| c.name().to_owned()).collect();
        let n = names.len();
        let place = |name: &String| {
            let found = names.iter().position(|other| other == name);
            found.ok_or_else(|| ModelError::Unknown { name: name.clone() })
        };
        let mut edge = vec![vec![true; n]; n];
        for (v, row) in edge.iter_mut().enumerate() {
            row[v] = false;
        }
        for (p, c) in &settings.forbidden {
            edge[place(p)?][place(c)?] = false;
        }
        let mut tier = vec![None; n];
        for (t, list) in settings.tiers.iter().enumerate() {
            for name in list {
                if tier[place(name)?].replace(t).is_some() {
                    return Err(ModelError::Duplicate { name: name.clone() });
                }
            }
        }
        for (p, row) in edge.iter_mut().enumerate() {
            for (c, may) in row.iter_mut().enumerate() {
                *may &= !matches!((tier[p], tier[c]), (Some(p), Some(c)) if p > c);
            }
        }
        let mut required = vec![Vec::new(); n];
        for (p, c) in &settings.required {
            let (parent, child) = (place(p)?, place(c)?);
            if !edge[parent][child] {
                let problem = format!("the edge to `{c}` is required and not allowed");
                return Err(ModelError::parameter(p, problem));
            }
            if !required[child].contains(&parent) {
                required[child].push(parent);
            }
        }
        for (child, list) in required.iter_mut().enumerate() {
            list.sort_unstable();
            if list.len() > settings.most_parents {
                let problem = format!(
                    "needs {} parents, most are {}",
                    list.len(),
                    settings.most_parents
                );
                return Err(ModelError::parameter(&names[child], problem));
            }
        }
        order(&required, &names)?;
        Ok(Self { edge, required })
    }

    /// True if p may be a parent of c.
    pub(super) fn may(&self, p: usize, c: usize) -> bool {
        self.edge[p][c]
    }

    /// True if the edge from p to c has to stay.
    pub(super) fn must(&self, p: usize, c: usize) -> bool {
        self.required[c].contains(&p)
    }
}
