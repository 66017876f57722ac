//! `jostle schema`.

use super::harness::Folder;

#[test]
fn schema_is_written_as_json_and_as_manual() {
    let folder = Folder::new("schema");
    let told = folder.jostle("schema").code(0);
    let schema: serde_json::Value = serde_json::from_str(&told.out).unwrap();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    assert!(schema["properties"]["forces"]["items"].is_object());
    folder.jostle("schema -o scene.schema.json").code(0);
    assert_eq!(folder.read("scene.schema.json"), told.out.as_bytes());
    let manual = folder.jostle("schema --manual").code(0).out;
    assert!(manual.starts_with("# The manual of the scene language\n"), "{manual}");
    let refused = folder.jostle("schema -o missing/scene.schema.json").code(2);
    assert!(refused.err.contains("missing/scene.schema.json"), "{}", refused.err);
}
