//! The graph of a network in the language of Graphviz.

use super::Network;

impl Network {
    /// A directed graph for Graphviz's `dot`: ellipses for discrete variables, boxes for real vectors.
    pub fn to_dot(&self) -> String {
        let mut out = String::from("digraph network {\n  rankdir=TB;\n");
        for (i, node) in self.nodes.iter().enumerate() {
            let shape = if node.is_discrete() { "ellipse" } else { "box" };
            out += &format!(
                "  n{i} [label=\"{}\", shape={shape}];\n",
                quoted(&node.name)
            );
        }
        for (i, node) in self.nodes.iter().enumerate() {
            for parent in &node.parents {
                out += &format!("  n{parent} -> n{i};\n");
            }
        }
        out + "}\n"
    }
}

fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' | '\r' => out.push(' '),
            _ => out.push(c),
        }
    }
    out
}
