use super::*;
use crate::{BarGroup, Merge, Outline, Scale, Series, Tile, category};

/// Every kind of panel, with hard data: gaps, logarithms of zero, long names.
fn all() -> Figure {
    let curve: Vec<_> = (1..200)
        .map(|i| f64::from(i) * 50.0)
        .map(|x| (x, 40.0 + 4000.0 / x))
        .collect();
    let band = curve
        .iter()
        .map(|&(x, y)| (x, 0.95 * y, 1.07 * y))
        .collect();
    let chart = Chart::new("Cost", Scale::new("iterations").log(), Scale::new("cost"))
        .series(Series::line("ADP", curve.clone()).band(band))
        .series(Series::dashed(
            "IS",
            curve.iter().map(|p| (p.0, 1.2 * p.1)).collect(),
        ))
        .series(Series::points(
            "runs",
            vec![(0.0, 60.0), (100.0, 70.0), (5000.0, 61.0)],
        ))
        .level(40.3, "paper 40.3");
    let cdf = Chart::new(
        "Retrieval",
        Scale::new("rank"),
        Scale::new("share").range(0.0, 1.0),
    )
    .series(Series::steps(
        "powerset",
        (1..20)
            .map(|r| (f64::from(r), 1.0 - 0.3 / f64::from(r)))
            .collect(),
    ))
    .series(Series::marked(
        "common rules",
        (1..20)
            .map(|r| (f64::from(r), 1.0 - 0.6 / f64::from(r)))
            .collect(),
    ))
    .legend(crate::Corner::BottomRight);
    let names: Vec<String> = "abcdefghij".chars().map(|c| format!("({c})")).collect();
    let bars = Bars::new("By facade", "facade", Scale::new("cost"), names.clone())
        .group("ADP", (0..10).map(|i| Some(50.0 + f64::from(i))).collect())
        .group_with_errors(BarGroup {
            name: "paper".into(),
            values: (0..10)
                .map(|i| (i != 3).then(|| 60.0 + f64::from(i)))
                .collect(),
            errors: vec![5.0; 10],
        });
    let matrix = (0..10)
        .map(|i: i32| (0..10).map(|j| f64::from((i - j).abs())).collect())
        .collect();
    let heat = HeatMap::new("Distances", matrix, "distance").names(names.clone(), names.clone());
    let merges = (0..9)
        .map(|k| Merge {
            left: if k == 0 { 0 } else { 9 + k },
            right: k + 1,
            height: 1.0 + k as f64,
        })
        .collect();
    let tree = Dendrogram::new("Clusters", "distance", names, merges)
        .groups((0..10).map(|i| i / 5).collect());
    let tiles = (0..12)
        .map(|i| Tile {
            x: f64::from(i % 4) * 10.0,
            y: f64::from(i / 4) * 15.0,
            width: 10.0,
            height: 15.0,
            colour: category(i as usize),
        })
        .collect();
    let tiles = Tiles::new("Layout", 40.0, 45.0, tiles)
        .caption("12 terminals")
        .outlines(vec![Outline {
            rect: [10.0, 15.0, 20.0, 15.0],
            colour: category(1),
            name: "NT1".into(),
        }]);
    Figure::new("every kind of panel", 3)
        .panel(chart)
        .panel(cdf)
        .panel(bars)
        .panel(heat)
        .panel(tree)
        .panel(tiles)
}

#[test]
fn files_are_pictures_and_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    write_figure(folder.path(), "a", &all()).unwrap();
    write_figure(folder.path(), "b", &all()).unwrap();
    assert_eq!(read("a.svg"), read("b.svg"));
    assert_eq!(read("a.png"), read("b.png"));
    let image = image::load_from_memory(&read("a.png")).unwrap();
    assert_eq!((image.width(), image.height()), (2 * 1460, 2 * 700));
    let svg = String::from_utf8(read("a.svg")).unwrap();
    assert!(
        svg.starts_with("<svg width=\"1460\" height=\"700\""),
        "{}",
        &svg[..80]
    );
    assert!(svg.contains("paper 40.3"));
    if let Some(out) = std::env::var_os("EDIFICE_SHOW_FIGURES") {
        write_figure(Path::new(&out), "panels", &all()).unwrap();
    }
}

#[test]
fn empty_panels_are_pictures_too() {
    let folder = tempfile::tempdir().unwrap();
    let figure = Figure::new("", 2)
        .panel(Chart::new("", Scale::new(""), Scale::new("").log()))
        .panel(Bars::new("", "", Scale::new(""), vec![]))
        .panel(HeatMap::new("", vec![], ""))
        .panel(Dendrogram::new("", "", vec![], vec![]));
    write_figure(folder.path(), "empty", &figure).unwrap();
}

#[test]
fn a_report_has_no_long_svg() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |tiles: usize| {
        let tile = |i: usize| Tile {
            x: (i % 50) as f64,
            y: (i / 50) as f64,
            width: 0.5,
            height: 0.5,
            colour: category(i),
        };
        let tiles = Tiles::new("", 50.0, 100.0, (0..tiles).map(tile).collect());
        write_report_figure(folder.path(), "a", &Figure::single("", tiles)).unwrap()
    };
    assert_eq!(picture(10), ["a.svg", "a.png"]);
    assert!(folder.path().join("a.svg").exists());
    assert_eq!(picture(4000), ["a.png"]);
    assert!(!folder.path().join("a.svg").exists());
}
