//! The needs of a task on a machine.

use serde::{Deserialize, Serialize};

/// The needs of a task on a machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TaskOptions {
    /// Processors.
    pub cpus: u32,
    /// Memory, as Slurm writes it.
    pub mem: String,
    /// Tasks are packed into jobs of about this long, such as `30min`.
    pub pack: String,
}

impl Default for TaskOptions {
    fn default() -> Self {
        Self {
            cpus: 1,
            mem: "1G".into(),
            pack: "30min".into(),
        }
    }
}

impl TaskOptions {
    /// Why a value is none, with its name.
    pub(super) fn check(&self) -> Result<(), String> {
        let digits = self.mem.trim_end_matches(['K', 'M', 'G', 'T']);
        let number = digits.parse::<u64>().is_ok_and(|n| n > 0);
        if !number || self.mem.len() > digits.len() + 1 {
            return Err(format!("mem: `{}` is no size such as 500M or 2G", self.mem));
        }
        if self.cpus == 0 {
            return Err("cpus: a task needs at least one processor".into());
        }
        match seconds(&self.pack) {
            Some(_) => Ok(()),
            None => Err(format!(
                "pack: `{}` is no length of time such as 90s, 30min or 2h",
                self.pack
            )),
        }
    }

    /// Seconds of a job of several tasks.
    pub fn pack_seconds(&self) -> f64 {
        // It was checked when the sweep file was read.
        seconds(&self.pack).unwrap_or(1800.0)
    }
}

/// Seconds of `90s`, `30min`, `2h`, `1.5h`.
fn seconds(text: &str) -> Option<f64> {
    let split = text.find(|c: char| !c.is_ascii_digit() && c != '.')?;
    let (number, unit) = text.split_at(split);
    let factor = match unit.trim() {
        "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return None,
    };
    let number: f64 = number.parse().ok()?;
    (number > 0.0).then_some(number * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_of_time_and_sizes() {
        assert_eq!(seconds("90s"), Some(90.0));
        assert_eq!(seconds("1.5 h"), Some(5400.0));
        assert_eq!(seconds("30min"), Some(1800.0));
        for bad in ["", "90", "s", "0s", "1.2.3h", "-1s", "5 days"] {
            assert_eq!(seconds(bad), None, "{bad}");
        }
        let with = |mem: &str| TaskOptions {
            mem: mem.into(),
            ..TaskOptions::default()
        };
        for good in ["1G", "500M", "2048", "1T"] {
            assert_eq!(with(good).check(), Ok(()), "{good}");
        }
        for bad in ["", "G", "0M", "1GB", "1MM", "two"] {
            assert!(with(bad).check().is_err(), "{bad}");
        }
    }
}
