//! Markdown tables.

/// The alignment of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A column: its heading, its alignment, and if it holds times or memory.
#[derive(Debug, Clone)]
struct Column {
    name: String,
    align: Align,
    times: bool,
}

/// A table with a title.
#[derive(Debug, Clone, Default)]
pub struct Table {
    title: String,
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..Self::default()
        }
    }

    /// Adds a column.
    pub fn column(mut self, name: impl Into<String>, align: Align) -> Self {
        self.columns.push(Column {
            name: name.into(),
            align,
            times: false,
        });
        self
    }

    /// Adds columns of numbers.
    pub fn numbers<S: Into<String>>(self, names: impl IntoIterator<Item = S>) -> Self {
        let names = names.into_iter();
        names.fold(self, |table, name| table.column(name, Align::Right))
    }

    /// Adds columns of times or memory, which differ from run to run: [`Table::without_times`] leaves them out.
    pub fn times<S: Into<String>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        let columns = names.into_iter().map(|name| Column {
            name: name.into(),
            align: Align::Right,
            times: true,
        });
        self.columns.extend(columns);
        self
    }

    /// True if a column holds times or memory.
    pub fn has_times(&self) -> bool {
        self.columns.iter().any(|c| c.times)
    }

    /// The table without the columns of times and memory: the same in every run.
    pub fn without_times(&self) -> Self {
        let columns = &self.columns;
        let kept = |row: &Vec<String>| {
            let cells = row.iter().zip(columns).filter(|(_, c)| !c.times);
            cells.map(|(cell, _)| cell.clone()).collect()
        };
        Self {
            title: self.title.clone(),
            columns: columns.iter().filter(|c| !c.times).cloned().collect(),
            rows: self.rows.iter().map(kept).collect(),
        }
    }

    /// Adds a row; missing cells stay empty, cells beyond the columns are dropped.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True if it has no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as Markdown, columns padded so that it also reads as plain text.
    pub fn markdown(&self) -> String {
        let cell = |row: &[String], i: usize| -> String {
            let text = row.get(i).map_or("", String::as_str);
            text.replace('|', "\\|").replace('\n', " ")
        };
        let names: Vec<String> = self.columns.iter().map(|c| c.name.clone()).collect();
        let widths: Vec<usize> = (0..names.len())
            .map(|i| {
                let all = std::iter::once(&names).chain(&self.rows);
                all.map(|row| cell(row, i).chars().count())
                    .max()
                    .unwrap_or(0)
                    .max(3)
            })
            .collect();
        let line = |row: &[String]| {
            let cells = widths.iter().enumerate().map(|(i, &width)| {
                let text = cell(row, i);
                match self.columns[i].align {
                    Align::Right => format!("{text:>width$}"),
                    _ => format!("{text:<width$}"),
                }
            });
            format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
        };
        let rule = widths
            .iter()
            .zip(&self.columns)
            .map(|(&width, column)| match column.align {
                Align::Right => format!("{}:", "-".repeat(width - 1)),
                _ => "-".repeat(width),
            });
        let mut lines = Vec::new();
        if !self.title.is_empty() {
            lines.push(format!("**{}**", self.title));
            lines.push(String::new());
        }
        lines.push(line(&names));
        lines.push(format!("| {} |", rule.collect::<Vec<_>>().join(" | ")));
        lines.extend(self.rows.iter().map(|row| line(row)));
        lines.join("\n")
    }

    /// The table for a LaTeX document that loads `booktabs`; the title is its caption.
    pub fn latex(&self) -> String {
        let letters: String = self
            .columns
            .iter()
            .map(|c| if c.align == Align::Right { 'r' } else { 'l' })
            .collect();
        let line = |cells: &mut dyn Iterator<Item = &str>| {
            let cells: Vec<String> = cells.map(latex).collect();
            format!("{} \\\\\n", cells.join(" & "))
        };
        let mut text = format!(
            "\\begin{{table}}\n\\centering\n\\caption{{{}}}\n",
            latex(&self.title)
        );
        text += &format!("\\begin{{tabular}}{{{letters}}}\n\\toprule\n");
        text += &line(&mut self.columns.iter().map(|c| c.name.as_str()));
        text += "\\midrule\n";
        for row in &self.rows {
            let cell = |i: usize| row.get(i).map_or("", String::as_str);
            text += &line(&mut (0..self.columns.len()).map(cell));
        }
        text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n"
    }
}

/// Text with LaTeX's special characters escaped.
fn latex(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped += "\\textbackslash{}",
            '~' => escaped += "\\textasciitilde{}",
            '^' => escaped += "\\textasciicircum{}",
            '<' => escaped += "$<$",
            '>' => escaped += "$>$",
            '±' => escaped += "$\\pm$",
            '×' => escaped += "$\\times$",
            '−' => escaped += "$-$",
            other => escaped.push(other),
        }
    }
    escaped
}
