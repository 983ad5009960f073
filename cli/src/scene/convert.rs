//! `scene convert`.

use super::{ply, toml};
use crate::args::ConvertArgs;
use crate::exit::{Failure, Stage};
use crate::report;
use crate::source::in_file;
use std::path::Path;
use twinlight::io::{load_with_settings, write_file};
use twinlight::scene::{Mesh, Scene};

/// Runs the command.
///
/// # Errors
/// Those of reading and writing; [`Failure::Usage`] for other extensions.
pub fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let extension = args.output.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !["ply", "toml"].contains(&extension.as_str()) {
        let what = format!("'{}': scenes are written as .toml or .ply", args.output.display());
        return Err(Failure::Usage(what));
    }
    if same_file(Path::new(&args.scene), &args.output) {
        let what = format!("'{}' is the scene that is read: name another file", args.output.display());
        return Err(Failure::Usage(what));
    }
    let (mut scene, settings) =
        load_with_settings(&args.scene, &args.load.options()).map_err(Failure::at(Stage::Input))?;
    let refused = |error| Failure::Library(Stage::Input, in_file(&args.scene, error));
    scene.validate(&args.load.limits()).map_err(refused)?;
    if !scene.motion.is_empty() {
        scene = scene.at(0.0).map_err(refused)?;
        report::notice("the scene is written as its motion begins; the motion is left out");
    }
    scene.notices.iter().for_each(|notice| report::notice(notice));
    let folder = args.output.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(|source| {
        Failure::Library(Stage::Output, twinlight::Error::Io { path: folder.to_path_buf(), source })
    })?;
    if extension == "toml" {
        return toml::write(&scene, &settings, &args.output);
    }
    report::notice("PLY holds geometry only: materials, lights and the camera are left out");
    let bytes = ply::encode(&flattened(&scene), |_| true);
    write_file(&args.output, &bytes).map_err(Failure::at(Stage::Output))?;
    report::print(&format!("{}\n", args.output.display()))
}

/// Whether two names lead to one file that exists.
fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// All instances as one mesh in world space. Normals and texture coordinates stay where every mesh has them.
fn flattened(scene: &Scene) -> Mesh {
    let used: Vec<&Mesh> = scene.instances.iter().map(|i| &scene.meshes[i.mesh as usize]).collect();
    let all = |has: fn(&Mesh) -> bool| !used.is_empty() && used.iter().all(|m| has(m));
    let (normals, texcoords) = (all(|m| !m.normals.is_empty()), all(|m| !m.texcoords.is_empty()));
    let mut flat = Mesh::default();
    for (instance, mesh) in scene.instances.iter().zip(used) {
        let (first, transform) = (flat.positions.len() as u32, &instance.transform);
        // A mirroring placement turns triangles inside out; exchanging two vertices turns them back.
        let mirrored = transform.determinant() < 0.0;
        flat.positions.extend(mesh.positions.iter().map(|&p| transform.point(p).as_vec3().to_array()));
        flat.triangles.extend(
            mesh.triangles
                .iter()
                .map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }.map(|v| v + first)),
        );
        if normals {
            let to_normal = transform.linear.inverse().transpose();
            flat.normals.extend(mesh.normals.iter().map(|n| {
                let [x, y, z] = n.map(f64::from);
                let n = to_normal.x_axis * x + to_normal.y_axis * y + to_normal.z_axis * z;
                n.normalize_or_zero().as_vec3().to_array()
            }));
        }
        if texcoords {
            flat.texcoords.extend(&mesh.texcoords);
        }
    }
    flat
}
