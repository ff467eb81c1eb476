//! The files in `datasets/` are those that the project's own commands make.

use std::path::Path;

use edifice_experiments::facade_grammar::data;

#[test]
fn shipped_facades_are_the_generators_byte_for_byte() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::copy(
        shipped.join("wu2014_fig9.cga"),
        folder.path().join("wu2014_fig9.cga"),
    )
    .expect("the printed grammar");
    data::write_layouts(folder.path(), data::LAYOUT_SEED).expect("layouts are made");
    let names = |folder: &Path| -> Vec<_> {
        let mut names: Vec<_> = std::fs::read_dir(folder)
            .expect("a folder")
            .map(|e| e.expect("an entry").file_name())
            .collect();
        names.sort();
        names
    };
    let (ours, theirs) = (folder.path().join("layouts"), shipped.join("layouts"));
    assert_eq!(names(&ours), names(&theirs));
    assert_eq!(names(&ours).len(), 68);
    let mut pairs: Vec<_> = names(&ours)
        .into_iter()
        .map(|name| (ours.join(&name), theirs.join(&name)))
        .collect();
    let figure = "wu2014_fig9.facade.json";
    pairs.push((folder.path().join(figure), shipped.join(figure)));
    for (made, kept) in pairs {
        let read = |path: &Path| std::fs::read(path).expect("a readable file");
        assert!(read(&made) == read(&kept), "{} differs", kept.display());
    }
}
