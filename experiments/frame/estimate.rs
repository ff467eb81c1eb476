//! The time that a run will take: as long as the same artefacts took when the same folder was filled last.

use super::options::Options;
use super::progress::line;
use super::provenance::Run;
use super::{Artefact, Experiment};

/// Seconds that an artefact of a folder took when it was made with these options; `None` if it was not.
pub(super) fn seconds_before(before: &Run, artefact: &Artefact, options: &Options) -> Option<f64> {
    let made = before.artefacts.get(artefact.name)?;
    let real = made.command.contains(" --data ");
    let alike = made.budget == options.budget.name()
        && real == options.data.is_some()
        && made.skipped.is_none();
    (alike && made.wall_seconds > 0.0).then_some(made.wall_seconds)
}

/// Says what is to come, and how long it took when this folder was filled last.
pub(super) fn say_how_long(
    chosen: &[(&'static Experiment, Vec<&'static Artefact>)],
    options: &Options,
) {
    let (mut all, mut known, mut seconds) = (0, 0, 0.0);
    for (experiment, artefacts) in chosen {
        let before = Run::read(&options.out.join(experiment.slug));
        all += artefacts.len();
        for took in artefacts
            .iter()
            .filter_map(|a| seconds_before(&before, a, options))
        {
            known += 1;
            seconds += took;
        }
    }
    if known > 0 {
        line(&format!(
            "{all} artefacts; {known} of them took {} when they were made last",
            readable_seconds(seconds)
        ));
    }
}

/// `3 s`, `12 min`.
pub(super) fn readable_seconds(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_read_aloud() {
        let read = [0.4, 43.0, 99.4, 100.0, 725.0].map(readable_seconds);
        assert_eq!(read, ["0 s", "43 s", "99 s", "2 min", "12 min"]);
    }
}
