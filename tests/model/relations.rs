//! Exact relations between columns: found, kept by every draw, and none where there is none.

use std::ops::ControlFlow;

use assert_cmd::Command;
use edifice::model::hierarchy::{Group, Settings};
use edifice::model::tables::relations::{TOLERANCE, find};
use edifice::model::tables::schema::{Kind, Schema, SchemaGroup};
use edifice::model::tables::table_model::TableModel;
use edifice::model::tables::{Dataset, learn::LearnedTable};
use edifice::model::{Cell, ModelError, Table};
use edifice::rng::stream;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

fn normals(count: usize, name: &str) -> Vec<f64> {
    let mut rng = stream(3, name, 0);
    (0..count)
        .map(|_| StandardNormal.sample(&mut rng))
        .collect()
}

/// Two parts and their total, which comes first; a part in feet; a ratio; a roof, said twice.
fn houses(rows: usize) -> Table {
    let (a, b, c) = (normals(rows, "a"), normals(rows, "b"), normals(rows, "c"));
    let ground: Vec<f64> = a.iter().map(|z| 50.0 + 10.0 * z).collect();
    let upper: Vec<f64> = b.iter().map(|z| 80.0 + 20.0 * z).collect();
    let width: Vec<f64> = c.iter().map(|z| (2.2 + 0.2 * z).exp()).collect();
    let roofs = a.iter().map(|z| Some(usize::from(*z > 0.3)));
    let roofs: Vec<Option<usize>> = roofs.collect();
    let both = |f: &dyn Fn(usize) -> f64| (0..rows).map(|i| Some(f(i))).collect::<Vec<_>>();
    let table = Table::new()
        .real("total", both(&|i| ground[i] + upper[i]))
        .and_then(|t| t.real("ground", both(&|i| ground[i])))
        .and_then(|t| t.real("upper", both(&|i| upper[i])))
        .and_then(|t| t.real("feet", both(&|i| ground[i] / 0.3048)))
        .and_then(|t| t.real("width", both(&|i| width[i])))
        .and_then(|t| t.real("depth", both(&|i| ground[i].abs() / width[i])))
        .and_then(|t| t.codes("roof", &["flat", "hip"], roofs.clone()))
        .and_then(|t| t.codes("top", &["flat", "hip"], roofs));
    table.unwrap()
}

fn schema(table: &Table) -> Schema {
    let group = |column: &edifice::model::Column| SchemaGroup {
        name: column.name().into(),
        kind: match column.categories() {
            None => Kind::Continuous,
            Some(_) => Kind::Category,
        },
        columns: vec![column.name().into()],
    };
    Schema {
        keep: Default::default(),
        missing: vec![String::new()],
        groups: table.columns().iter().map(group).collect(),
        relations: None,
    }
}

fn learned(table: &Table) -> LearnedTable {
    let schema = schema(table);
    let data = Dataset {
        table: table.clone(),
        groups: schema.groups(),
    };
    let settings = Settings {
        styles: 1..=2,
        ..Settings::default()
    };
    let go_on = |_: Option<&_>| ControlFlow::Continue(());
    TableModel::learn(&data, &schema, &settings, 1, &go_on).unwrap()
}

fn real(table: &Table, column: &str, row: usize) -> f64 {
    match table.column(column).unwrap().cell(row) {
        Cell::Real(value) => value,
        other => panic!("{column}, row {row}: {other:?}"),
    }
}

fn kept(table: &Table, row: usize) {
    let x = |name: &str| real(table, name, row);
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} is not {b}");
    near(x("total"), x("ground") + x("upper"));
    near(x("feet"), x("ground") / 0.3048);
    near(x("depth"), x("ground") / x("width"));
    let code = |name: &str| table.column(name).unwrap().cell(row);
    assert_eq!(code("roof"), code("top"));
}

#[test]
fn relations_are_found_and_every_draw_keeps_them() {
    let table = houses(200);
    let found = learned(&table).model;
    let said = |m: &TableModel| {
        let relations = m.schema.relations.as_ref().unwrap();
        relations.iter().map(|r| r.said()).collect::<Vec<_>>()
    };
    let expected = [
        "top = roof",
        "total = ground + upper",
        "feet = 3.280839895013123 ground",
        "depth = ground * width^-1",
    ];
    assert_eq!(said(&found), expected);
    // What is written is read back; the model has the other columns alone.
    let read = TableModel::from_json(&found.to_json().unwrap()).unwrap();
    assert_eq!(said(&read), expected);
    let mut rng = stream(1, "draws", 0);
    let drawn = read.sample(300, &mut rng).unwrap();
    let names = drawn.columns().iter().map(|c| c.name());
    assert!(names.eq(table.columns().iter().map(|c| c.name())));
    (0..300).for_each(|row| kept(&drawn, row));
    let kinds = |t: &Table| -> Vec<_> {
        let columns = t.columns().iter();
        columns
            .map(|c| (c.name().to_owned(), c.categories().map(<[String]>::to_vec)))
            .collect()
    };
    let columns = read.columns().unwrap();
    assert_eq!((columns.rows(), kinds(&columns)), (0, kinds(&drawn)));
    // The spread of what is computed is that of the table: 200 rows, 300 draws.
    let mean =
        |t: &Table| (0..t.rows()).map(|r| real(t, "total", r)).sum::<f64>() / t.rows() as f64;
    assert!((mean(&drawn) - mean(&table)).abs() < 7.0);
    // The density is that of the other columns.
    let logs = read.log_likelihood(&table).unwrap();
    let others = ["ground", "upper", "width", "roof"];
    let alone = read.log_likelihood(&table.in_order(&others).unwrap());
    assert_eq!(logs, alone.unwrap());
    // ... also where another column says what one of them is.
    let others = ["total", "upper", "width", "top"];
    let told = read.log_likelihood(&table.in_order(&others).unwrap());
    let told = told.unwrap();
    assert!(logs.iter().zip(told).all(|(a, b)| (a - b).abs() < 1e-6));
}

#[test]
fn a_row_that_breaks_a_relation_is_refused() {
    let table = houses(100);
    let model = learned(&table).model;
    let row = table
        .select(&[4, 5])
        .in_order(&["ground", "upper"])
        .unwrap();
    let totals = [
        Some(real(&table, "total", 4)),
        Some(real(&table, "total", 5) + 1e-4),
    ];
    let broken = row.real("total", totals).unwrap();
    let error = model.log_likelihood(&broken).unwrap_err();
    assert!(
        matches!(&error, ModelError::Contradiction { row: Some(1), variable } if variable.contains("total"))
    );
    let mut rng = stream(1, "draws", 0);
    assert_eq!(model.complete(&broken, 1, &mut rng).unwrap_err(), error);
}

#[test]
fn parts_of_a_known_total_are_drawn_given_it() {
    let model = learned(&houses(1000)).model;
    let total = 130.0 + 3.0 * 500.0_f64.sqrt();
    let given = Table::new().real("total", [Some(total)]).unwrap();
    let count = 400;
    let drawn = model
        .complete(&given, count, &mut stream(1, "draws", 0))
        .unwrap();
    let parts = (0..count).map(|row| {
        kept(&drawn, row);
        assert_eq!(real(&drawn, "total", row).to_bits(), total.to_bits());
        real(&drawn, "ground", row)
    });
    let parts: Vec<f64> = parts.collect();
    let mean = parts.iter().sum::<f64>() / count as f64;
    let variance = parts.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count as f64;
    println!("mean {mean:.2}, deviation {:.2}", variance.sqrt());
    // Of normals: 50 + 100 / 500 of what the total has more, deviation sqrt(100 * 400 / 500). A part drawn without regard to the
    // total would have 50 and 10.
    assert!((mean - 63.4).abs() < 2.5, "{mean}");
    assert!((variance.sqrt() - 8.94).abs() < 1.5, "{variance}");
}

#[test]
fn nothing_is_found_where_nothing_is() {
    let column = |k: usize| normals(40, &format!("column {k}"));
    let mut wide = Table::new();
    for k in 0..60 {
        wide = wide
            .real(&format!("x{k}"), column(k).into_iter().map(Some))
            .unwrap();
    }
    assert_eq!(find(&wide), []);
    // A copy among more columns than rows is found.
    let doubled = column(7).into_iter().map(|x| Some(1e6 * x + 2.0));
    let said = find(&wide.real("far", doubled).unwrap());
    assert_eq!(
        said.iter().map(|r| r.said()).collect::<Vec<_>>(),
        ["far = 1000000 x7 + 2"]
    );
    // A sum that was rounded, or off by more than the tolerance.
    let (a, b) = (normals(200, "a"), normals(200, "b"));
    for unit in [0.01, 3e3 * TOLERANCE] {
        let sums = a
            .iter()
            .zip(&b)
            .map(|(a, b)| Some(((a + b) / unit).round() * unit));
        let table = Table::new()
            .real("a", a.iter().copied().map(Some))
            .and_then(|t| t.real("b", b.iter().copied().map(Some)))
            .and_then(|t| t.real("sum", sums.collect::<Vec<_>>()));
        assert_eq!(find(&table.unwrap()), [], "{unit}");
    }
    // Two rare flags that chance made equal.
    let rare = (0..100).map(|row| Some(row == 40));
    let table = Table::new().binary("a", rare.clone()).unwrap();
    assert_eq!(find(&table.binary("b", rare).unwrap()), []);
}

#[test]
fn random_sums_are_found_in_any_unit() {
    for seed in 0..40 {
        let mut rng = stream(seed, "sums", 0);
        let unit = 10_f64.powi(rng.random_range(-6..7));
        let parts = rng.random_range(1..6);
        let columns: Vec<Vec<f64>> = (0..parts)
            .map(|_| {
                (0..120)
                    .map(|_| unit * (5.0 + rng.random::<f64>()))
                    .collect()
            })
            .collect();
        let weights: Vec<f64> = (0..parts)
            .map(|_| f64::from(rng.random_range(1..9)))
            .collect();
        let mut table = Table::new();
        for (k, column) in columns.iter().enumerate() {
            let name = format!("x{k}");
            table = table.real(&name, column.iter().copied().map(Some)).unwrap();
        }
        let sum = |row| {
            weights
                .iter()
                .zip(&columns)
                .map(|(w, c)| w * c[row])
                .sum::<f64>()
        };
        let table = table.real("y", (0..120).map(|row| Some(sum(row)))).unwrap();
        let found = find(&table);
        assert_eq!(found.len(), 1, "{seed}");
        assert!(
            found[0].column == "y" || parts == 1,
            "{seed}: {}",
            found[0].said()
        );
        let terms = weights.iter().enumerate().map(|(k, w)| match *w {
            1.0 => format!("x{k}"),
            w => format!("{w} x{k}"),
        });
        let terms = terms.collect::<Vec<_>>().join(" + ");
        assert_eq!(found[0].said(), format!("y = {terms}"), "{seed}");
    }
}

#[test]
fn commands_state_and_keep_relations() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (table, model) = (at("houses.csv"), at("houses.table-model.json"));
    let houses = houses(120);
    let mut text = String::from("total,ground,upper\n");
    for row in 0..120 {
        let x = |name: &str| real(&houses, name, row);
        text += &format!("{},{},{}\n", x("total"), x("ground"), x("upper"));
    }
    std::fs::write(&table, &text).unwrap();
    let run = |words: &[&str], code: i32| {
        let mut command = Command::cargo_bin("edifice").unwrap();
        let done = command.arg("model").args(words).assert().code(code);
        let output = done.get_output();
        let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (said(&output.stdout), said(&output.stderr))
    };
    let (schema, _) = run(&["schema", &table], 0);
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    assert_eq!(schema["version"], 2);
    assert_eq!(schema["relations"][0]["column"], "total");
    let learn = ["learn", &table, "-o", &model, "--max-styles", "2"];
    let (_, notes) = run(&learn, 0);
    assert!(
        notes.contains("exact relation: total = ground + upper"),
        "{notes}"
    );
    let numbers = |text: &str| {
        let lines = text.lines().skip(1);
        let cells = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
        lines.map(cells).collect::<Vec<Vec<f64>>>()
    };
    let part = at("part.csv");
    std::fs::write(&part, "upper,total\n80,131\n,140\n").unwrap();
    let (drawn, _) = run(&["sample", &model, "-n", "100"], 0);
    let (given, _) = run(&["sample", &model, "--given", "total=150", "-n", "20"], 0);
    let (completed, _) = run(&["complete", &model, &part, "-n", "5"], 0);
    let mut all = numbers(&drawn);
    all.extend(numbers(&given));
    assert!(all[100..].iter().all(|row| (row[0] - 150.0).abs() < 1e-6));
    all.extend(numbers(&completed));
    assert_eq!(all.len(), 130);
    assert!((all[120][1] - 51.0).abs() < 1e-9, "{:?}", all[120]);
    for row in all {
        assert!(
            (row[0] - row[1] - row[2]).abs() <= 1e-9 * row[0].abs(),
            "{row:?}"
        );
    }
    std::fs::write(&part, "total,ground,upper\n130,50,80\n130,50,81\n").unwrap();
    let (_, complaint) = run(&["score", &model, &part], 1);
    assert!(
        complaint.contains("row 2") && complaint.contains("total"),
        "{complaint}"
    );
    // A schema that states no relation keeps from seeking them.
    let mut plain = schema.clone();
    plain["relations"] = serde_json::json!([]);
    let path = at("plain.schema.json");
    std::fs::write(&path, plain.to_string()).unwrap();
    let (_, notes) = run(&[&learn[..], &["--schema", &path]].concat(), 0);
    assert!(!notes.contains("exact relation"), "{notes}");
    plain["relations"] = serde_json::json!([{ "column": "total", "form": "sum", "constant": 0, "terms": [["total", 1]] }]);
    std::fs::write(&path, plain.to_string()).unwrap();
    let (_, complaint) = run(&[&learn[..], &["--schema", &path]].concat(), 1);
    assert!(
        complaint.contains("determined determines another"),
        "{complaint}"
    );
}

#[test]
fn groups_lose_determined_columns() {
    let table = houses(60);
    let groups = vec![
        Group::new("sizes", &["ground", "upper", "total"]),
        Group::new("feet", &["feet"]),
    ];
    let data = Dataset {
        table: table
            .in_order(&["ground", "upper", "total", "feet"])
            .unwrap(),
        groups,
    };
    let schema = schema(&data.table).related(&data);
    let reduced = schema.relations().unwrap().reduce_dataset(&data).unwrap();
    assert_eq!(reduced.groups, [Group::new("sizes", &["ground", "upper"])]);
}
