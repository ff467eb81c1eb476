use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use edifice_report::Row;

static RUNS: AtomicUsize = AtomicUsize::new(0);
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

/// Five units; the run breaks off at the limit, as a kill would.
fn squares(ctx: &mut Context) -> edifice_base::Result<()> {
    let units = [1u64, 2, 3, 4, 5];
    let answers: Vec<f64> = ctx.units(
        &units,
        |u| format!("square/{u}"),
        |u| {
            if RUNS.fetch_add(1, Ordering::SeqCst) >= LIMIT.load(Ordering::SeqCst) {
                return Err(edifice_base::Error::Interrupted);
            }
            Ok((u * u) as f64 + 0.1)
        },
    )?;
    for (unit, value) in units.iter().zip(answers) {
        ctx.observe(Row {
            instance: unit.to_string(),
            metric: "square".into(),
            value,
            ..Row::default()
        });
    }
    ctx.compare("five squared", "25", "25.1");
    Ok(())
}

fn nothing(ctx: &mut Context) -> edifice_base::Result<()> {
    ctx.skip("there is no data");
    Ok(())
}

static FAKE: Experiment = Experiment {
    slug: "fake",
    paper: "Nobody 2000: Squares",
    artefacts: &[
        Artefact {
            name: "table_1",
            title: "squares",
            run: squares,
        },
        Artefact {
            name: "table_2",
            title: "nothing",
            run: nothing,
        },
    ],
    documents: |_| Vec::new(),
};

static PROGRAM: Program = Program {
    experiments: &[&FAKE],
    sources: Sources {
        crates: &[],
        commit: None,
        dirty: None,
    },
};

fn options(out: &std::path::Path) -> Options {
    Options {
        only: Vec::new(),
        data: None,
        own: Vec::new(),
        seed: 1,
        budget: Budget::Smoke,
        out: out.to_path_buf(),
        threads: 1,
        verify: false,
    }
}

#[test]
fn a_run_that_was_stopped_goes_on_where_it_was() {
    let whole = tempfile::tempdir().unwrap();
    let parts = tempfile::tempdir().unwrap();
    let csv = |out: &std::path::Path| std::fs::read(out.join("fake/table_1.csv")).unwrap();
    run(&PROGRAM, &[&FAKE], &options(whole.path())).unwrap();
    assert_eq!(RUNS.load(Ordering::SeqCst), 5);

    RUNS.store(0, Ordering::SeqCst);
    LIMIT.store(3, Ordering::SeqCst);
    let stopped = run(&PROGRAM, &[&FAKE], &options(parts.path()));
    assert!(matches!(stopped, Err(edifice_base::Error::Interrupted)));
    assert!(parts.path().join("fake/.work").exists());

    // Another artefact's run, which goes on with nothing of this one, takes nothing from it.
    let mut other = options(parts.path());
    other.only = vec!["table_2".into()];
    run(&PROGRAM, &[&FAKE], &other).unwrap();

    RUNS.store(0, Ordering::SeqCst);
    LIMIT.store(usize::MAX, Ordering::SeqCst);
    let report = run(&PROGRAM, &[&FAKE], &options(parts.path())).unwrap();
    assert_eq!(
        RUNS.load(Ordering::SeqCst),
        2,
        "three of five units were finished"
    );
    assert_eq!(csv(whole.path()), csv(parts.path()));
    assert_eq!(report.made, ["fake/table_1"]);
    assert_eq!(report.skipped[0].0, "fake/table_2");
    assert!(!parts.path().join("fake/.work").exists());
    let index = std::fs::read_to_string(&report.index).unwrap();
    assert!(index.contains("five squared") && index.contains("25.1"));
}

#[test]
fn a_folder_that_another_run_has_is_refused() {
    let out = tempfile::tempdir().unwrap();
    let mut table = options(out.path());
    table.only = vec!["table_2".into()];
    let folder = out.path().join("fake");
    std::fs::create_dir(&folder).unwrap();
    let other = lock::Lock::take(&folder).unwrap();
    let message = run(&PROGRAM, &[&FAKE], &table).unwrap_err().to_string();
    assert!(
        message.contains("fake: another run writes here"),
        "{message}"
    );
    drop(other);
    run(&PROGRAM, &[&FAKE], &table).unwrap();
}
