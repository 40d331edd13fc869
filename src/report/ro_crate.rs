//! A study as an RO-Crate: one folder that holds experiments, reference, tables, figures and pages, and a description of
//! them that machines read (RO-Crate 1.1, JSON-LD). Each run is an action with its inputs and its results; each column of a
//! table is a variable with its unit.
//!
//! Only what is up to date goes in, and the folder appears as a whole or not at all. With all experiments it holds the whole study,
//! which `shotdamp` can open there; with some of them their pages have no links to what is left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::committed::present;
use super::dead_links::without_dead_links;
use super::publication::publication_reasons;
use super::verdicts::judge_all;
use super::views;
use crate::atomic::{self, FileError};
use crate::experiment::{AboutStudy, Author, Licence};
use crate::reference::ReferenceFile;
use crate::study::{ASSUMPTIONS, FileHash, Item, Record, STUDY, State, Study, record_name, table_name};
use crate::table::{ParquetError, Table, parquet};
use crate::text::json;

/// When this version was released; a crate has to say when it was published, and nobody's clock is asked.
pub const RELEASED: &str = "2026-11-21";

const CONTEXT: &str = "https://w3id.org/ro/crate/1.1/context";
const CONFORMS_TO: &str = "https://w3id.org/ro/crate/1.1";

/// Why there is no crate.
#[derive(Debug, thiserror::Error)]
pub enum CrateError {
    /// Results that are not those of today's inputs.
    #[error("not up to date: {}; `shotdamp run` brings them up to date, then export again", .0.join(", "))]
    NotUpToDate(Vec<String>),
    /// Something is there already.
    #[error("{} is there already; name a folder that is not", .0.display())]
    Exists(PathBuf),
    /// A table that cannot be read.
    #[error(transparent)]
    Table(#[from] ParquetError),
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Writes the crate of these experiments into `folder`, which must not exist; returns the number of its files.
///
/// # Errors
/// [`CrateError`], and then there is no such folder.
pub fn export_crate(study: &Study, items: &[&Item], folder: &Path, published: &str) -> Result<usize, CrateError> {
    if folder.exists() {
        return Err(CrateError::Exists(folder.into()));
    }
    let mut crated = Crate::default();
    let mut stale = Vec::new();
    for item in items {
        match &item.state {
            State::Current(record) if publication_reasons(study, item).is_empty() => crated.add(study, item, record)?,
            _ => stale.push(item.source.experiment.id.to_string()),
        }
    }
    let is_whole = items.len() == study.texts.ids().len();
    if is_whole && stale.is_empty() {
        stale = crated.add_rest(study)?;
    }
    if !stale.is_empty() {
        return Err(CrateError::NotUpToDate(stale));
    }
    crated.leave_out_dead_links();
    let description = json::page(&crated.metadata(&study.about, published));
    crated.files.insert("ro-crate-metadata.json".into(), description.into_bytes());
    write_whole(&crated.files, folder)?;
    Ok(crated.files.len())
}

/// Fills a hidden neighbour and gives it the name at the end; whoever is killed in between leaves the neighbour.
fn write_whole(files: &BTreeMap<String, Vec<u8>>, folder: &Path) -> Result<(), FileError> {
    let fail = |source| FileError { action: "write", path: folder.to_path_buf(), source };
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(fail)?;
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    let neighbour = builder.prefix(atomic::PREFIX).tempdir_in(parent).map_err(fail)?;
    for (name, bytes) in files {
        atomic::write(&neighbour.path().join(name), bytes)?;
    }
    fs::rename(neighbour.path(), folder).map_err(fail)?;
    // It has another name now: there is nothing left to remove.
    let _ = neighbour.keep();
    Ok(())
}

/// What goes into a crate.
#[derive(Default)]
struct Crate {
    files: BTreeMap<String, Vec<u8>>,
    /// The description of each file, run and column, by id.
    entities: BTreeMap<String, Value>,
    actions: Vec<Value>,
}

impl Crate {
    fn add(&mut self, study: &Study, item: &Item, record: &Record) -> Result<(), CrateError> {
        let experiment = &item.source.experiment;
        let id = &experiment.id;
        let mut inputs = vec![
            self.text(study, &item.source.file, format!("Experiment: {}", experiment.title)),
            self.text(study, ASSUMPTIONS, "Assumptions: the inputs that the study leaves open".into()),
        ];
        if study.texts.files.contains_key(STUDY) {
            inputs.push(self.text(study, STUDY, "Study: what it is, and what it concludes".into()));
        }
        if let Some(name) = study.reference_names().get(id.0.as_str()) {
            let entries = study.references.get(&id.0).map_or(0, |file: &ReferenceFile| file.entries.len());
            inputs.push(self.text(study, name, format!("Reference: {entries} numbers and claims of the study")));
        }
        let name = table_name(id);
        let bytes = read_as_recorded(study, &name, &record.table)?;
        let table = parquet::from_bytes(bytes.clone(), &name)?;
        let columns = self.columns(&table);
        let mut results = vec![self.file(&name, &format!("Table: {}", experiment.title), bytes)];
        self.describe(&name, "variableMeasured", columns);
        let kept = record_name(id);
        results.push(self.file(&kept, &format!("Record: {}", experiment.title), read(study, &kept)?));
        for (name, hash) in record.publication.iter().flat_map(|publication| &publication.files) {
            let kind = if name.ends_with(".md") { "Page" } else { "Figure" };
            let bytes = read_as_recorded(study, name, hash)?;
            results.push(self.file(name, &format!("{kind}: {}", experiment.title), bytes));
        }
        let action = format!("#run-{id}");
        let run = json!({
            "@id": action,
            "@type": "CreateAction",
            "name": format!("Simulation of {id}: {}", experiment.title),
            "description": experiment.about,
            "instrument": {"@id": "#shotdamp"},
            "object": inputs,
            "result": results,
            "identifier": item.fingerprint(),
        });
        self.entities.insert(action.clone(), run);
        self.actions.push(json!({"@id": action}));
        Ok(())
    }

    /// All that belongs to no experiment: every other text, and every report. Returns the reports that are not up to date.
    fn add_rest(&mut self, study: &Study) -> Result<Vec<String>, CrateError> {
        for name in study.texts.files.keys() {
            if !self.files.contains_key(name) {
                self.text(study, name, name.clone());
            }
        }
        for name in present(study) {
            if !self.files.contains_key(&name) {
                self.file(&name, &name, read(study, &name)?);
            }
        }
        let now = views::of_the_study(study, &judge_all(study));
        let departs =
            |(name, text): &(String, String)| self.files.get(name).is_none_or(|bytes| bytes != text.as_bytes());
        Ok(now.into_iter().filter(departs).map(|(name, _)| name).collect())
    }

    fn leave_out_dead_links(&mut self) {
        let names: BTreeSet<String> = self.files.keys().cloned().collect();
        let pages = self.files.iter_mut().filter(|(name, _)| name.ends_with(".md"));
        for (name, bytes) in pages {
            let Ok(text) = std::str::from_utf8(bytes) else { continue };
            let page = without_dead_links(text, name, |name| names.contains(name));
            if let Some(Value::Object(entity)) = self.entities.get_mut(name) {
                entity.insert("contentSize".into(), page.len().to_string().into());
            }
            *bytes = page.into_bytes();
        }
    }

    /// One of the study's texts as it was when it was read.
    fn text(&mut self, study: &Study, name: &str, title: String) -> Value {
        let bytes = study.texts.bytes(name).map(<[u8]>::to_vec).unwrap_or_default();
        self.file(name, &title, bytes)
    }

    fn file(&mut self, name: &str, title: &str, bytes: Vec<u8>) -> Value {
        let format = match name.rsplit('.').next() {
            Some("parquet") => "application/vnd.apache.parquet",
            Some("png") => "image/png",
            Some("svg") => "image/svg+xml",
            Some("md") => "text/markdown",
            Some("json") => "application/json",
            Some("html") => "text/html",
            _ => "application/yaml",
        };
        let entity = json!({
            "@id": name,
            "@type": "File",
            "name": title,
            "encodingFormat": format,
            "contentSize": bytes.len().to_string(),
        });
        self.entities.insert(name.into(), entity);
        self.files.insert(name.into(), bytes);
        json!({"@id": name})
    }

    fn describe(&mut self, id: &str, key: &str, value: Value) {
        if let Some(Value::Object(entity)) = self.entities.get_mut(id) {
            entity.insert(key.into(), value);
        }
    }

    /// The columns with a unit or a symbol. The same column of several experiments is the same variable.
    fn columns(&mut self, table: &Table) -> Value {
        let mut columns = Vec::new();
        for column in table.columns.iter().filter(|column| !column.unit.is_empty() || !column.symbol.is_empty()) {
            let unit = if column.unit.is_empty() { "1" } else { &column.unit };
            let description: String = unit.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
            let id = format!("#{}-{description}", column.name);
            let name = if column.symbol.is_empty() { String::new() } else { format!(" ({})", column.symbol) };
            let entity = json!({
                "@id": id,
                "@type": "PropertyValue",
                "name": format!("{}{name}", column.name),
                "unitText": unit,
            });
            self.entities.insert(id.clone(), entity);
            columns.push(json!({"@id": id}));
        }
        single_or_all(columns)
    }

    fn metadata(&self, about: &AboutStudy, published: &str) -> Value {
        let parts: Vec<Value> = self.files.keys().map(|name| json!({"@id": name})).collect();
        let mut graph = vec![
            json!({
                "@id": "ro-crate-metadata.json",
                "@type": "CreativeWork",
                "conformsTo": {"@id": CONFORMS_TO},
                "about": {"@id": "./"},
            }),
            json!({
                "@id": "./",
                "@type": "Dataset",
                "name": about.title.as_deref().unwrap_or("A study"),
                "description": "Experiments with the numbers and claims that they are compared with, tables, figures and verdicts",
                "datePublished": published,
                "hasPart": parts,
                "mentions": single_or_all(self.actions.clone()),
            }),
            json!({
                "@id": "#shotdamp",
                "@type": "SoftwareApplication",
                "name": "shotdamp",
                "description": env!("CARGO_PKG_DESCRIPTION"),
                "softwareVersion": env!("CARGO_PKG_VERSION"),
                "version": env!("CARGO_PKG_VERSION"),
            }),
        ];
        if let Some(source) = &about.source {
            graph[1]["citation"] = json!({"@id": "#study"});
            graph.push(json!({"@id": "#study", "@type": source.kind, "name": source.name}));
        }
        let mut refer = |keys: &[&str], entities: Vec<Value>| {
            if entities.is_empty() {
                return;
            }
            let ids: Vec<Value> = entities.iter().map(|entity| json!({"@id": entity["@id"]})).collect();
            for key in keys {
                graph[1][*key] = single_or_all(ids.clone());
            }
            graph.extend(entities);
        };
        let author = |(number, author): (usize, &Author)| {
            let (kind, name) = match author {
                Author::Person(name) => ("Person", name),
                Author::Organisation(name) => ("Organization", name),
            };
            json!({"@id": format!("#author-{}", number + 1), "@type": kind, "name": name})
        };
        refer(&["author", "publisher"], about.authors.iter().enumerate().map(author).collect());
        let licence = |licence: &Licence| json!({"@id": licence.address(), "@type": "CreativeWork", "name": licence.0});
        refer(&["license"], about.licences.iter().map(licence).collect());
        graph.extend(self.entities.values().cloned());
        json!({"@context": CONTEXT, "@graph": graph})
    }
}

/// A list of one is written as the one.
fn single_or_all(mut values: Vec<Value>) -> Value {
    if values.len() == 1 { values.remove(0) } else { Value::Array(values) }
}

fn read(study: &Study, name: &str) -> Result<Vec<u8>, FileError> {
    let path = study.layout.path(name);
    fs::read(&path).map_err(|source| FileError { action: "read", path, source })
}

/// The bytes of an output, if they are those that were recorded.
fn read_as_recorded(study: &Study, name: &str, hash: &FileHash) -> Result<Vec<u8>, FileError> {
    let fail = |source| FileError { action: "read", path: study.layout.path(name), source };
    let bytes = read(study, name)?;
    if FileHash::of(&bytes) == *hash {
        Ok(bytes)
    } else {
        Err(fail(std::io::Error::other("it is not what was written; `shotdamp run` writes it again")))
    }
}
