//! A data set in Croissant 1.0, the metadata of ML Commons (JSON-LD).

use edifice_base::file::media_type;
use serde_json::{Value, json};

use super::set::{Found, Set};

/// The metadata of a set with the digests of its files.
pub(super) fn metadata(set: &Set, files: &[Found]) -> Value {
    let object = |file: &Found| {
        json!({
            "@type": "cr:FileObject", "@id": file.name, "name": file.name, "contentUrl": file.name,
            "contentSize": format!("{} B", file.bytes), "encodingFormat": media_type(&file.name),
            "sha256": file.sha256,
        })
    };
    json!({
        "@context": context(),
        "@type": "sc:Dataset",
        "name": set.name,
        "alternateName": set.title,
        "description": set.about,
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "license": set.licence,
        "url": set.url,
        "citeAs": set.citation,
        "version": "1.0.0",
        "keywords": set.labels,
        "distribution": files.iter().map(object).collect::<Vec<_>>(),
    })
}

/// The context that Croissant 1.0 prescribes.
fn context() -> Value {
    json!({
        "@language": "en", "@vocab": "https://schema.org/", "citeAs": "cr:citeAs", "column": "cr:column",
        "conformsTo": "dct:conformsTo", "cr": "http://mlcommons.org/croissant/", "rai": "http://mlcommons.org/croissant/RAI/",
        "data": { "@id": "cr:data", "@type": "@json" },
        "dataType": { "@id": "cr:dataType", "@type": "@vocab" },
        "dct": "http://purl.org/dc/terms/",
        "examples": { "@id": "cr:examples", "@type": "@json" },
        "extract": "cr:extract", "field": "cr:field", "fileProperty": "cr:fileProperty", "fileObject": "cr:fileObject",
        "fileSet": "cr:fileSet", "format": "cr:format", "includes": "cr:includes", "isLiveDataset": "cr:isLiveDataset",
        "jsonPath": "cr:jsonPath", "key": "cr:key", "md5": "cr:md5", "parentField": "cr:parentField", "path": "cr:path",
        "recordSet": "cr:recordSet", "references": "cr:references", "regex": "cr:regex", "repeated": "cr:repeated",
        "replace": "cr:replace", "sc": "https://schema.org/", "separator": "cr:separator", "source": "cr:source",
        "subField": "cr:subField", "transform": "cr:transform",
    })
}
