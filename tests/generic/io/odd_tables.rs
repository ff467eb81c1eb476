//! Tables that are not plain CSV: each is read as it is meant, or refused with a sentence that says why; none is misread without a word.

use std::path::Path;

use edifice::io::building_csv::parse;

/// The expectation of a table: its header and rows with a word of the note, or a word of the refusal.
enum Expected {
    Read(&'static str, &'static str),
    Refused(&'static str),
}

use Expected::{Read, Refused};

/// The cells of a table, `,` between and `/` after each line.
fn flat(header: Vec<String>, rows: Vec<Vec<String>>) -> String {
    let lines = std::iter::once(header).chain(rows);
    let lines: Vec<String> = lines.map(|cells| cells.join(",")).collect();
    lines.join("/")
}

#[test]
fn none_is_misread_without_a_word() {
    let cases: &[(&[u8], Expected)] = &[
        (b"a,b\n1,2\n", Read("a,b/1,2", "")),
        (b"a,b\r\n1.5,x\r\n", Read("a,b/1.5,x", "")),
        (b"a,b\r1.5,x\r", Read("a,b/1.5,x", "")),
        (b"\xef\xbb\xbfa,b\n1,2\n", Read("a,b/1,2", "")),
        (b"a,b\n1,x\n\n2,y\n\n", Read("a,b/1,x/2,y", "")),
        (b"a;b\n1;2\n", Read("a,b/1,2", "separated by ';'")),
        (b"a\tb\n1\t2\n", Read("a,b/1,2", "separated by '\\t'")),
        (b"a|b\n1|2\n", Read("a,b/1,2", "separated by '|'")),
        (
            b"sep=;\r\na;b\r\n1,5;2\r\n",
            Read("a,b/1.5,2", "decimal commas"),
        ),
        (
            b"\xef\xbb\xbfsep=\t\na\tb\n1\t2\n",
            Read("a,b/1,2", "separated by '\\t'"),
        ),
        (
            b"\"a;1\";b\n\"x;y\";1\n",
            Read("a;1,b/x;y,1", "separated by ';'"),
        ),
        (b"a,b\n\"x\ny\",1\n", Read("a,b/x\ny,1", "")),
        (b"a,b\n\"say \"\"x\"\"\",1\n", Read("a,b/say \"x\",1", "")),
        (
            b"a;b\n1,5;x\n-2,25;y\n",
            Read(
                "a,b/1.5,x/-2.25,y",
                "column `a`: numbers with decimal commas",
            ),
        ),
        (
            b"a;b\n1.234,5;x\n12,0;y\n",
            Read("a,b/1234.5,x/12.0,y", "decimal commas"),
        ),
        (
            b"a,b\n\"1,234\",x\n\"12,345,678\",y\n",
            Read("a,b/1234,x/12345678,y", "commas between thousands"),
        ),
        (
            b"a,b\n\"1,234.5\",x\nNA,y\n",
            Read("a,b/1234.5,x/NA,y", "commas between thousands"),
        ),
        (b"a,b\n1,2\n3,NULL\n4,6\n", Read("a,b/1,2/3,NULL/4,6", "")),
        (
            b"a,b\n1,2\n3,none\n4,6\n5,7\n",
            Read(
                "a,b/1,2/3,none/4,6/5,7",
                "column `b`: 3 of 4 known cells are numbers, but not \"none\"",
            ),
        ),
        (
            b"a,b\n1,2\n3,inf\n4,6\n",
            Read("a,b/1,2/3,inf/4,6", "but not \"inf\""),
        ),
        (
            b"a,b,\n1,2,\n",
            Read("a,b,column_3/1,2,", "column 3 has no name"),
        ),
        (b"1,2\n3,4\n", Read("1,2/3,4", "first line")),
        (
            b"first name\nJohn Smith\nJane Doe\n",
            Read("first name/John Smith/Jane Doe", ""),
        ),
        (b"id,tags\n1,x;y\n2,z;w\n", Read("id,tags/1,x;y/2,z;w", "")),
        (b"", Refused("empty")),
        (b"\xef\xbb\xbf\n", Refused("empty")),
        (b"a,b\n", Refused("no rows")),
        (b"a,b,a\n1,2,3\n", Refused("`a` twice, as columns 1 and 3")),
        (b"a,b\n1,2,3\n", Refused("line 2")),
        (b"# made by hand\na,b\n1,2\n", Refused("line 2")),
        (b"a,b\n1,$1,234\n", Refused("line 2")),
        (b"a b\n1 2\n3 4\n", Refused("separated by blanks")),
        (b"a    b\n  1  x\n 12  y\n", Refused("separated by blanks")),
        (b"a;b,c\n1;2,5\n2;3,5\n", Refused("by ',' or by ';'")),
        (
            b"a;b\n1,234;x\n2,345;y\n",
            Refused("decimal comma or parted thousands"),
        ),
        (b"caf\xe9,b\n1,2\n", Refused("line 1")),
        (b"\xff\xfea\0,\0b\0", Refused("UTF-16")),
        (b"PAR1\x15\x04\x15", Refused("Parquet")),
        (b"ARROW1\0\0", Refused("Arrow")),
        (b"PK\x03\x04", Refused("Excel")),
        (b"SQLite format 3\0", Refused("SQLite")),
        (
            b"% about\n\n@RELATION iris\n@ATTRIBUTE a REAL\n@DATA\n1\n",
            Refused("ARFF"),
        ),
        (b"<html><table></table></html>", Refused("HTML")),
        (b"{\"a\": 1}\n{\"a\": 2}\n", Refused("JSON")),
        (b"[\n{\"a\": 1}]\n", Refused("JSON")),
    ];
    for (bytes, expected) in cases {
        let text = String::from_utf8_lossy(bytes);
        match (parse(bytes, Path::new("table.csv")), expected) {
            (Ok(table), Read(cells, note)) => {
                assert_eq!(flat(table.header, table.rows), *cells, "{text:?}");
                let notes = table.notes.join("\n");
                assert!(notes.contains(note), "{text:?}: {notes}");
                assert_eq!(notes.is_empty(), note.is_empty(), "{text:?}: {notes}");
            }
            (Err(error), Refused(why)) => {
                assert!(error.to_string().contains(why), "{text:?}: {error}");
            }
            (Ok(table), Refused(why)) => panic!("{text:?}: {table:?}, not refused: {why}"),
            (Err(error), Read(..)) => panic!("{text:?}: {error}"),
        }
    }
}
