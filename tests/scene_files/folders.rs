//! Which files a scene may read.

use std::path::{Path, PathBuf};
use twinlight::io::resolve::{Files, Resolver, percent_decoded};
use twinlight::io::{LoadOptions, load};

/// A folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(label: &str) -> Self {
        let path = std::env::temp_dir().join(format!("twinlight-{label}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(path.join("scene/sub")).unwrap();
        let folder = Self(path.canonicalize().unwrap());
        folder.write("secret.mtl", "newmtl secret\n");
        folder.write("scene/inside.mtl", "newmtl inside\n");
        folder.write("scene/a b%41.txt", "plain");
        folder.write("scene/sub/deep.mtl", "newmtl deep\n");
        folder
    }

    fn write(&self, path: &str, text: &str) {
        std::fs::write(self.0.join(path), text).unwrap();
    }

    fn scene(&self) -> PathBuf {
        self.0.join("scene/a.obj")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn only_the_scenes_folder_is_read() {
    let folder = Folder::new("only");
    let files = Resolver::new(&folder.scene(), &LoadOptions::default()).unwrap();
    for path in ["inside.mtl", "./inside.mtl", "sub/../inside.mtl", "sub\\deep.mtl", "sub//deep.mtl"] {
        assert!(files.read_path(path).is_ok(), "{path}");
    }
    let absolute = folder.0.join("secret.mtl");
    let inside = folder.0.join("scene/inside.mtl");
    assert!(files.read_path(inside.to_str().unwrap()).is_ok());
    let outside = [
        "../secret.mtl",
        "..\\secret.mtl",
        "sub/../../secret.mtl",
        "../scene/../secret.mtl",
        "../absent.mtl",
        absolute.to_str().unwrap(),
        "/etc/passwd",
    ];
    for path in outside {
        let message = files.read_path(path).unwrap_err().to_string();
        assert!(message.contains("lies outside the scene's folder"), "{path}: {message}");
        assert!(files.beside(path).is_err() && files.identity(path).is_err(), "{path}");
    }
    for path in
        ["file:///etc/passwd", "https://example.org/a.mtl", "C:\\a.mtl", "data:text/plain,a", "", "a\0b"]
    {
        assert!(files.read_path(path).is_err(), "{path}");
    }
    let deep = files.beside("sub/deep.mtl").unwrap();
    assert!(deep.read_path("deep.mtl").is_ok() && deep.read_path("../inside.mtl").is_ok());
    assert!(deep.read_path("../../secret.mtl").is_err());
}

#[cfg(unix)]
#[test]
fn links_and_pipes_do_not_lead_out() {
    let folder = Folder::new("links");
    std::os::unix::fs::symlink("../secret.mtl", folder.0.join("scene/link.mtl")).unwrap();
    std::os::unix::fs::symlink("..", folder.0.join("scene/up")).unwrap();
    std::os::unix::fs::symlink("inside.mtl", folder.0.join("scene/good.mtl")).unwrap();
    let files = Resolver::new(&folder.scene(), &LoadOptions::default()).unwrap();
    for path in ["link.mtl", "up/secret.mtl"] {
        assert!(files.read_path(path).unwrap_err().to_string().contains("lies outside"), "{path}");
    }
    assert!(files.read_path("good.mtl").is_ok());
    // A device would never end; a folder is no file.
    std::os::unix::fs::symlink("/dev/zero", folder.0.join("scene/zero.obj")).unwrap();
    let device = folder.0.join("scene/zero.obj");
    let message = load(device.to_str().unwrap(), &LoadOptions::default()).unwrap_err().to_string();
    assert!(message.ends_with("is not a regular file"), "{message}");
    assert!(files.read_path("sub").unwrap_err().to_string().ends_with("is not a regular file"));
}

#[test]
fn more_folders_only_when_allowed() {
    let folder = Folder::new("allowed");
    folder.write("scene/a.obj", "mtllib ../secret.mtl\nv 0 0 0\nusemtl secret\nf 1 1 1\n");
    let path = folder.scene();
    let mut options = LoadOptions::default();
    let message = load(path.to_str().unwrap(), &options).unwrap_err().to_string();
    assert!(message.starts_with("a.obj:1:8: reference '../secret.mtl': lies outside"), "{message}");
    options.allow_paths.push(folder.0.clone());
    assert_eq!(load(path.to_str().unwrap(), &options).unwrap().materials[0].name, "secret");
}

#[test]
fn sizes_are_checked_before_reading() {
    let folder = Folder::new("sizes");
    let mut options = LoadOptions { max_file_bytes: 10, ..LoadOptions::default() };
    folder.write("scene/a.obj", "v 0 0 0\nv 0 0 0\n");
    let message = load(folder.scene().to_str().unwrap(), &options).unwrap_err().to_string();
    assert!(message.ends_with("a.obj: bytes of the file: needs 16, the limit is 10"), "{message}");
    options.max_file_bytes = 1000;
    options.limits.max_bytes = 20;
    let files = Resolver::new(&folder.scene(), &options).unwrap();
    assert!(files.read_path("inside.mtl").is_ok());
    // Views from other folders share the budget.
    let message = files.beside("sub/deep.mtl").unwrap().read_path("deep.mtl").unwrap_err().to_string();
    assert_eq!(message, "bytes of the scene's files: needs 12, the limit is 6");
}

#[test]
fn uris_are_decoded_and_paths_are_not() {
    let folder = Folder::new("uris");
    let files = Resolver::new(&folder.scene(), &LoadOptions::default()).unwrap();
    assert_eq!(Files::read(&files, "a%20b%2541.txt").unwrap(), b"plain");
    assert_eq!(files.read_path("a b%41.txt").unwrap(), b"plain");
    assert!(Files::read(&files, "%2e%2e/secret.mtl").unwrap_err().to_string().contains("lies outside"));
    for (uri, expected) in [
        ("a%2", "URI 'a%2': '%' at byte 1 is not followed by two hexadecimal digits"),
        ("a%zz", "URI 'a%zz': '%' at byte 1 is not followed by two hexadecimal digits"),
        ("%ff", "URI '%ff': its percent-encoding is not UTF-8"),
    ] {
        assert_eq!(percent_decoded(uri).unwrap_err().to_string(), expected);
    }
    assert!(Resolver::new(Path::new("nowhere/at/all.obj"), &LoadOptions::default()).is_err());
}
