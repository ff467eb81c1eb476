//! Names of the choices of a program.

use std::borrow::Cow;
use std::fmt;

/// The place of a choice in a program: a name, and the indices of the plates around it.
///
/// Made from a name, `"mu"`, or from a name and one or two indices, `("theta", i)` and `("cell", i, j)`. One run of a program
/// may use each address once.
///
/// # Examples
/// ```
/// use edifice_model::program::Address;
/// assert_eq!(Address::from("mu").to_string(), "mu");
/// assert_eq!(Address::from(("cell", 3, 0)).to_string(), "cell[3,0]");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address {
    name: Cow<'static, str>,
    index: [u32; 2],
    depth: u8,
}

impl Address {
    /// The name without indices.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The indices, outermost first; none to two.
    pub fn indices(&self) -> &[u32] {
        &self.index[..usize::from(self.depth)]
    }
}

impl From<&'static str> for Address {
    fn from(name: &'static str) -> Self {
        Self {
            name: Cow::Borrowed(name),
            index: [0; 2],
            depth: 0,
        }
    }
}

impl From<String> for Address {
    fn from(name: String) -> Self {
        Self {
            name: Cow::Owned(name),
            index: [0; 2],
            depth: 0,
        }
    }
}

impl From<(String, u32)> for Address {
    fn from((name, i): (String, u32)) -> Self {
        Self {
            name: Cow::Owned(name),
            index: [i, 0],
            depth: 1,
        }
    }
}

impl From<(String, u32, u32)> for Address {
    fn from((name, i, j): (String, u32, u32)) -> Self {
        Self {
            name: Cow::Owned(name),
            index: [i, j],
            depth: 2,
        }
    }
}

impl From<(&'static str, usize)> for Address {
    fn from((name, i): (&'static str, usize)) -> Self {
        Self {
            name: Cow::Borrowed(name),
            index: [i as u32, 0],
            depth: 1,
        }
    }
}

impl From<(&'static str, usize, usize)> for Address {
    fn from((name, i, j): (&'static str, usize, usize)) -> Self {
        Self {
            name: Cow::Borrowed(name),
            index: [i as u32, j as u32],
            depth: 2,
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.indices() {
            [] => f.write_str(&self.name),
            [i] => write!(f, "{}[{i}]", self.name),
            [i, j, ..] => write!(f, "{}[{i},{j}]", self.name),
        }
    }
}
