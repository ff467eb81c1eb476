//! The description of a data set: `dataset.toml`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_io::{ReadOptions, building_csv, read_bytes, read_source};
use edifice_model::network::Network;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Set {
    /// Name in commands and rows.
    pub name: String,
    /// Its title.
    pub title: String,
    /// `facades`, `houses`, `cities` or `networks`.
    pub kind: String,
    /// Its contents, in a line.
    pub about: String,
    /// The address that it is to be had from.
    pub url: String,
    /// Its licence.
    pub licence: String,
    /// The work to cite.
    pub citation: String,
    /// Patterns of its files.
    pub files: Vec<String>,
    /// Number of files.
    pub count: usize,
    /// Labels that occur, of facades.
    #[serde(default)]
    pub labels: Vec<String>,
    /// Names of files by split, where the set has splits.
    #[serde(default, skip_serializing_if = "std::collections::BTreeMap::is_empty")]
    pub splits: std::collections::BTreeMap<String, Vec<String>>,
}

/// A file of a set.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    /// Its path below the set's folder, with `/` between folders.
    pub name: String,
    /// Its size in bytes.
    pub bytes: u64,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

/// The sets that are described.
///
/// # Errors
/// [`Error::Content`] for a description that is none.
pub(super) fn described() -> Result<Vec<Set>> {
    let files = edifice_datasets::files().into_iter();
    files
        .filter(|(name, _)| name.starts_with("sets/") && name.ends_with(".toml"))
        .map(|(name, bytes)| Set::parse(&String::from_utf8_lossy(bytes), Path::new(&name)))
        .collect()
}

impl Set {
    fn parse(text: &str, path: &Path) -> Result<Self> {
        toml::from_str(text).map_err(|e: toml::de::Error| {
            let at = e.span().map_or(0, |span| span.start);
            let before = text.get(..at).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or_default().len() + 1;
            let message = e.message().to_owned();
            Error::input(path, format!("line {line}, column {column}"), message)
        })
    }

    /// Reads a description.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Input`] with line and column.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| Error::io(path, "read", e))?;
        Self::parse(&text, path)
    }

    /// A description of a folder to begin with.
    pub(super) fn skeleton(folder: &Path, files: &[String]) -> Result<Self> {
        let absolute = std::path::absolute(folder).map_err(|e| Error::io(folder, "find", e))?;
        let name = absolute.file_name().unwrap_or_default().to_string_lossy();
        let mut set = Self {
            name: name
                .to_lowercase()
                .replace(|c: char| !c.is_ascii_alphanumeric(), "_"),
            title: name.into_owned(),
            kind: "facades".into(),
            about: "describe the set in a line".into(),
            url: "https://example.org".into(),
            licence: "https://spdx.org/licenses/CC-BY-4.0.html".into(),
            citation: String::new(),
            files: files.to_vec(),
            count: 0,
            labels: Vec::new(),
            splits: Default::default(),
        };
        set.count = set.find(folder)?.len();
        Ok(set)
    }

    /// The files that there are below a folder, in order of name; never the description itself.
    ///
    /// # Errors
    /// [`Error::Option`] for a pattern that is none.
    pub(super) fn find(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        for pattern in &self.files {
            let place = folder.join(pattern);
            let found = glob::glob(&place.to_string_lossy());
            let found = found.map_err(|e| Error::option("files", format!("{pattern:?}: {e}")))?;
            files.extend(found.flatten().filter(|path| path.is_file()));
        }
        let own = ["dataset.toml", "croissant.json"];
        files.retain(|path| own.iter().all(|name| !path.ends_with(name)));
        files.sort();
        files.dedup();
        Ok(files)
    }

    /// Reads a file as its kind; the error says why it cannot be read.
    pub(super) fn check(&self, path: &Path) -> std::result::Result<(), String> {
        let told = |e: Error| e.to_string();
        match self.kind.as_str() {
            "facades" => read_source(path, &ReadOptions::default())
                .map(|_| ())
                .map_err(told),
            "houses" => match path.to_string_lossy().contains(".csv") {
                true => building_csv::read(path).map(|_| ()).map_err(told),
                false => edifice_io::building_json::read(path)
                    .map(|_| ())
                    .map_err(told),
            },
            "networks" => {
                let bytes = read_bytes(path).map_err(told)?;
                let text = String::from_utf8(bytes).map_err(|e| e.to_string())?;
                let network = Network::from_bif(&text);
                network
                    .map(|_| ())
                    .map_err(|e| format!("{}: {e}", path.display()))
            }
            // A city is read when it is used: here only that there is something in the file.
            _ => match std::fs::metadata(path) {
                Ok(about) if about.len() > 0 => Ok(()),
                Ok(_) => Err(format!("{}: it is empty", path.display())),
                Err(e) => Err(format!("{}: {e}", path.display())),
            },
        }
    }

    /// Sizes and digests of all files.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(super) fn digests(&self, folder: &Path) -> Result<Vec<Found>> {
        let mut all = Vec::new();
        for path in self.find(folder)? {
            let bytes = std::fs::read(&path).map_err(|e| Error::io(&path, "read", e))?;
            let below = path.strip_prefix(folder).unwrap_or(&path);
            let digest = Sha256::digest(&bytes);
            all.push(Found {
                name: below.to_string_lossy().replace('\\', "/"),
                bytes: bytes.len() as u64,
                sha256: digest.iter().map(|b| format!("{b:02x}")).collect(),
            });
        }
        Ok(all)
    }
}
