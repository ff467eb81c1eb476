//! Facades of equal windows at other sizes.

use std::collections::BTreeSet;

use super::{BandsError, MOST_TIMES, resized};
use edifice_shape::{Facade, Rect, Region};

/// Windows of 10 x 15 in `columns` and `rows`, 20 and 30 apart.
fn windows(columns: u32, rows: u32) -> Facade {
    let mut regions = Vec::new();
    let (width, height) = (
        f64::from(columns) * 20.0 + 10.0,
        f64::from(rows) * 30.0 + 15.0,
    );
    let mut put = |label: &str, x: f64, y: f64, w: f64, h: f64| {
        regions.push(Region {
            label: label.into(),
            rect: Rect::new(x, y, w, h),
        });
    };
    for row in 0..=rows {
        let y = f64::from(row) * 30.0;
        put("wall", 0.0, y, width, 15.0);
        if row == rows {
            break;
        }
        for column in 0..=columns {
            let x = f64::from(column) * 20.0;
            put("wall", x, y + 15.0, 10.0, 15.0);
            if column < columns {
                put("window", x + 10.0, y + 15.0, 10.0, 15.0);
            }
        }
    }
    Facade::new("windows", "cm", width, height, regions).unwrap()
}

#[test]
fn a_grid_gets_columns_and_floors_and_its_windows_keep_their_size() {
    let own = windows(4, 3);
    for (columns, rows) in [(6, 3), (8, 5), (3, 2), (4, 4)] {
        let want = windows(columns, rows);
        let found = resized(&own, want.width, want.height).unwrap();
        found.facade.check_tiling().unwrap();
        let count = |f: &Facade| f.regions.iter().filter(|r| r.label == "window").count();
        assert_eq!(count(&found.facade), count(&want));
        assert!(found.scale.iter().all(|scale| (scale - 1.0).abs() < 1e-9));
        assert!(found.cut.is_empty());
    }
}

#[test]
fn its_own_size_is_the_identity_and_one_window_is_stretched() {
    let own = windows(4, 3);
    assert_eq!(resized(&own, own.width, own.height).unwrap().facade, own);
    let one = windows(1, 1);
    let found = resized(&one, 2.0 * one.width, one.height).unwrap();
    assert_eq!(found.facade.regions.len(), one.regions.len());
    assert_eq!(found.scale, [2.0, 1.0]);
    found.facade.check_tiling().unwrap();
}

#[test]
fn a_facade_twenty_times_as_wide_is_made_and_a_wider_one_refused() {
    let own = windows(3, 2);
    let most = MOST_TIMES * own.width;
    let found = resized(&own, most, own.height).unwrap();
    found.facade.check_tiling().unwrap();
    assert!((found.scale[0] - 1.0).abs() < 0.05, "{:?}", found.scale);
    let refused = resized(&own, 1e9 * own.width, own.height);
    assert!(matches!(refused, Err(BandsError::Size { .. })));
}

#[test]
fn the_unit_does_not_matter() {
    let own = windows(5, 4);
    let small = |f: &Facade, k: f64| {
        let mut out = f.clone();
        (out.width, out.height) = (k * f.width, k * f.height);
        for region in &mut out.regions {
            let r = region.rect;
            region.rect = Rect::new(k * r.x, k * r.y, k * r.width, k * r.height);
        }
        out
    };
    let there = resized(&own, 170.0, 160.0).unwrap();
    let back = resized(&small(&own, 0.01), 1.7, 1.6).unwrap();
    assert_eq!(there.bands, back.bands);
    assert_eq!(there.facade.regions.len(), back.facade.regions.len());
}

#[test]
fn windows_are_repeated_with_all_their_panes() {
    // One floor of windows of two panes in frames, a lintel over each.
    let of = |count: u32| {
        let width = f64::from(count) * 4.0 + 1.4;
        let mut regions = Vec::new();
        let mut put = |label: &str, x: f64, y: f64, w: f64, h: f64| {
            let label = label.into();
            regions.push(Region {
                label,
                rect: Rect::new(x, y, w, h),
            });
        };
        put("wall", 0.0, 0.0, width, 1.0);
        put("wall", 0.0, 3.5, width, 1.0);
        put("wall", 0.0, 1.0, 1.4, 2.5);
        for k in 0..count {
            let x = 1.4 + 4.0 * f64::from(k);
            for (label, start, width) in [
                ("frame", 0.0, 0.2),
                ("glass", 0.2, 1.0),
                ("frame", 1.2, 0.2),
                ("glass", 1.4, 1.0),
                ("frame", 2.4, 0.2),
            ] {
                put(label, x + start, 1.0, width, 2.0);
            }
            put("lintel", x, 3.0, 2.6, 0.5);
            put("wall", x + 2.6, 1.0, 1.4, 2.5);
        }
        Facade::new("panes", "m", width, 4.5, regions).unwrap()
    };
    let own = of(4);
    for count in [2, 3, 5, 8] {
        let want = of(count);
        let found = resized(&own, want.width, want.height).unwrap();
        let sorted = |f: &Facade| {
            let places = f.regions.iter().filter(|r| r.label == "glass");
            let mut starts: Vec<i64> = places.map(|r| (r.rect.x * 1e3).round() as i64).collect();
            starts.sort_unstable();
            starts
        };
        assert_eq!(sorted(&found.facade), sorted(&want));
        assert!((found.scale[0] - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_floor_is_added_with_its_cornice() {
    // Three floors of windows; a cornice of two thirds of a window's height stands above the second alone.
    let mut regions = Vec::new();
    let mut put = |label: &str, x: f64, y: f64, w: f64, h: f64| {
        let label = label.into();
        let rect = Rect::new(x, y, w, h);
        regions.push(Region { label, rect });
    };
    let starts = [4.0, 16.0, 34.0];
    let mut at = 0.0;
    for start in starts {
        put("wall", 0.0, at, 20.0, start - at);
        for x in [0.0, 8.0, 16.0] {
            put("wall", x, start, 4.0, 6.0);
        }
        for x in [4.0, 12.0] {
            put("window", x, start, 4.0, 6.0);
        }
        at = start + 6.0;
    }
    put("wall", 0.0, at, 20.0, 4.0);
    let cornice = regions
        .iter()
        .position(|r| r.rect.y == 22.0 && r.label == "wall")
        .unwrap();
    regions.remove(cornice);
    for (label, y, h) in [
        ("wall", 22.0, 2.0),
        ("cornice", 24.0, 4.0),
        ("wall", 28.0, 6.0),
    ] {
        let rect = Rect::new(0.0, y, 20.0, h);
        regions.push(Region {
            label: label.into(),
            rect,
        });
    }
    let own = Facade::new("cornice", "m", 20.0, 44.0, regions).unwrap();
    let pitch = |f: &Facade| {
        let mut ys: Vec<f64> = f
            .regions
            .iter()
            .filter(|r| r.label == "window")
            .map(|r| r.rect.y)
            .collect();
        ys.sort_by(f64::total_cmp);
        ys.dedup();
        ys.windows(2)
            .map(|w| w[1] - w[0])
            .fold(f64::INFINITY, f64::min)
    };
    for times in [1.3, 1.6, 2.0] {
        let found = resized(&own, 20.0, times * own.height).unwrap();
        found.facade.check_tiling().unwrap();
        assert!(found.bands[1] > 0, "{times}");
        assert!(
            pitch(&found.facade) / found.scale[1] >= 0.95 * pitch(&own),
            "{times}"
        );
    }
}

#[test]
fn numbered_kinds_of_walls_are_walls() {
    let own = windows(4, 3);
    let mut numbered = own.clone();
    for (k, region) in numbered.regions.iter_mut().enumerate() {
        if region.label == "wall" && region.rect.width < 20.0 {
            region.label = format!("Wall{}", 1 + k % 2);
        }
    }
    for (width, height) in [(own.width, 1.5 * own.height), (own.width, 2.0 * own.height)] {
        let plain = resized(&own, width, height).unwrap();
        let found = resized(&numbered, width, height).unwrap();
        assert_eq!(found.bands, plain.bands);
        assert!(found.bands[1] > 0);
    }
}

/// A shop with a door beside it; windows above that are in line on the left alone.
fn shop_house() -> Facade {
    let mut regions = Vec::new();
    let mut row = |y: f64, h: f64, elements: &[(&str, f64, f64)]| {
        let mut at = 0.0;
        let mut put = |label: &str, x: f64, width: f64| {
            regions.push(Region {
                label: label.into(),
                rect: Rect::new(x, y, width, h),
            });
        };
        for &(label, x, width) in elements {
            put("wall", at, x - at);
            put(label, x, width);
            at = x + width;
        }
        put("wall", at, 40.0 - at);
    };
    row(0.0, 25.0, &[("door", 3.0, 12.0), ("shop", 18.0, 19.0)]);
    row(25.0, 10.0, &[]);
    for (y, elements) in [(35.0, 1), (55.0, 1), (75.0, 2), (95.0, 1)] {
        row(
            y,
            12.0,
            &[("window", 6.0, 8.0), ("window", 22.0, 8.0)][..elements],
        );
        row(y + 12.0, 8.0, &[]);
    }
    row(115.0, 5.0, &[("vent", 17.0, 4.0)]);
    row(120.0, 5.0, &[]);
    Facade::new("shop", "dm", 40.0, 125.0, regions).unwrap()
}

#[test]
fn a_narrow_house_at_twice_its_width_is_two() {
    let own = shop_house();
    own.check_tiling().unwrap();
    let found = resized(&own, 2.0 * own.width, own.height).unwrap();
    found.facade.check_tiling().unwrap();
    let count = |f: &Facade, label: &str| f.regions.iter().filter(|r| r.label == label).count();
    for label in ["door", "shop", "window", "vent"] {
        assert_eq!(
            count(&found.facade, label),
            2 * count(&own, label),
            "{label}"
        );
    }
}

/// Whole houses and single columns are added, never taken away: whatever the width, the door and its wall stay.
#[test]
fn a_house_is_never_taken_away() {
    for own in [shop_house(), windows(1, 1), windows(2, 2)] {
        let before = labels(&own);
        for times in [0.05, 0.1, 0.16, 0.2, 0.3, 0.5, 0.7, 0.9] {
            let found = resized(&own, times * own.width, own.height).unwrap();
            found.facade.check_tiling().unwrap();
            assert_eq!(labels(&found.facade), before, "{times}");
        }
    }
}

/// Four columns of windows above a wide door below the second one, between shops below one and below two.
fn wide_door() -> Facade {
    let mut facade = windows(4, 3);
    let high = 15.0;
    facade.regions.retain(|r| r.rect.y > 0.0);
    for (label, from, to) in [
        ("shop", 0.0, 20.0),
        ("door", 20.0, 45.0),
        ("shop", 45.0, 90.0),
    ] {
        facade.regions.push(Region {
            label: label.into(),
            rect: Rect::new(from, 0.0, to - from, high),
        });
    }
    facade.check_tiling().unwrap();
    facade
}

#[test]
fn a_column_is_not_cut_out_of_a_door() {
    let own = wide_door();
    let door = |f: &Facade| {
        let door = f.regions.iter().find(|r| r.label == "door").unwrap();
        (door.rect.x, door.rect.width)
    };
    // The seams of the second column would both lie within the door, those of the last one lie within a shop below two.
    let narrow = resized(&own, 70.0, own.height).unwrap();
    assert_eq!(narrow.scale[0], 1.0);
    assert_eq!(door(&narrow.facade), (20.0, 25.0));
    assert_eq!(narrow.facade.regions.len(), own.regions.len() - 6);
    let wide = resized(&own, 110.0, own.height).unwrap();
    assert_eq!(door(&wide.facade).1, 25.0);
    // Of the shop below two windows one column is left, and no more is taken away.
    let narrower = resized(&own, 50.0, own.height).unwrap();
    assert!((door(&narrower.facade).1 - 25.0 * narrower.scale[0]).abs() < 1e-9);
    narrower.facade.check_tiling().unwrap();
}

fn labels(facade: &Facade) -> BTreeSet<&str> {
    facade.regions.iter().map(|r| r.label.as_str()).collect()
}
