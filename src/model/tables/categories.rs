//! The category that a text means.

/// The categories of a column, made ready to read texts.
///
/// A text means the category of that name; else, where the categories are `no` and `yes`, the one that it is another word for (0/1,
/// false/true, in any case); else, where every category is a bin of numbers ([`Binned::names`](super::bins::Binned::names)), the bin
/// that its number lies in.
///
/// # Examples
/// ```
/// use edifice_model::tables::categories::Meanings;
/// let names = |all: &[&str]| -> Vec<String> { all.iter().map(|n| n.to_string()).collect() };
/// let garage = names(&["yes", "no"]);
/// assert_eq!(Meanings::new(&garage).code("TRUE"), Some(0));
/// let width = names(&["< 9.5", "9.5 .. 12", ">= 12"]);
/// let width = Meanings::new(&width);
/// assert_eq!(["9.5", ">= 12", "wide"].map(|text| width.code(text)), [Some(1), Some(2), None]);
/// ```
#[derive(Debug, Clone)]
pub struct Meanings<'a> {
    names: &'a [String],
    /// Codes of `no` and `yes`, where these are all.
    flags: Option<[usize; 2]>,
    /// Lowest number of each bin, and the one that it ends before; none where some category is no bin.
    bins: Vec<(f64, f64)>,
}

impl<'a> Meanings<'a> {
    /// Those of categories with these names.
    pub fn new(names: &'a [String]) -> Self {
        let at = |wanted: &str| names.iter().position(|name| name == wanted);
        let flags = at("no").zip(at("yes")).filter(|_| names.len() == 2);
        let bins: Option<Vec<(f64, f64)>> = names.iter().map(|name| bin(name)).collect();
        Self {
            names,
            flags: flags.map(|(no, yes)| [no, yes]),
            bins: bins.unwrap_or_default(),
        }
    }

    /// Code of the category that a text means; `None` where it means none.
    pub fn code(&self, text: &str) -> Option<usize> {
        let named = self.names.iter().position(|name| name == text);
        let other_word = || Some(self.flags?[usize::from(flag(text)?)]);
        named.or_else(other_word).or_else(|| {
            let number: f64 = text.parse().ok()?;
            let holds = |(from, to): &(f64, f64)| *from <= number && number < *to;
            self.bins.iter().position(holds)
        })
    }
}

/// No or yes, in any of the words for them.
pub(super) fn flag(text: &str) -> Option<bool> {
    match text.to_ascii_lowercase().as_str() {
        "0" | "0.0" | "no" | "false" => Some(false),
        "1" | "1.0" | "yes" | "true" => Some(true),
        _ => None,
    }
}

/// The bin of a name: its lowest number, and the one that it ends before.
fn bin(name: &str) -> Option<(f64, f64)> {
    let number = |text: &str| text.parse().ok().filter(|x: &f64| x.is_finite());
    if let Some(to) = name.strip_prefix("< ") {
        return Some((f64::NEG_INFINITY, number(to)?));
    }
    if let Some(from) = name.strip_prefix(">= ") {
        return Some((number(from)?, f64::INFINITY));
    }
    let (from, to) = name.split_once(" .. ")?;
    Some((number(from)?, number(to)?))
}
