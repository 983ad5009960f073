//! What a person sees when a file is wrong.

use crate::read;
use twinlight::io::{LoadOptions, load};

fn error(name: &str, text: &str, others: &[(&str, &str)]) -> String {
    let strict = LoadOptions { strict: true, ..LoadOptions::default() };
    match read(name, text, others, &strict) {
        Ok(_) => panic!("{name} was accepted:\n{text}"),
        Err(e) => e.to_string(),
    }
}

#[test]
fn obj_errors_name_line_column_and_value() {
    let cases = [
        ("v 0 0 0\nv 1 x2 0\n", "a.obj:2:5: y 'x2' is not a number"),
        ("v 0 0,5 0\n", "a.obj:1:5: y '0,5' is not a number; the decimal mark is a point"),
        ("v 0 nan 0\n", "a.obj:1:5: y 'nan' is not a finite 32-bit number"),
        ("v 0 0 1e39\n", "a.obj:1:7: z '1e39' is not a finite 32-bit number"),
        ("v 0 0\n", "a.obj:1:1: 'v' needs 3 numbers: its z is missing"),
        ("v 0 0 0 0\n", "a.obj:1:9: weight 0 puts the vertex at infinity"),
        ("v 0 0 0\nf 1 1 4\n", "a.obj:2:7: vertex index 4 in '4': 1 are defined so far"),
        ("v 0 0 0\nf 1 1 0\n", "a.obj:2:7: vertex index 0 in '0': indices count from 1"),
        ("v 0 0 0\nf 1 1/2 1\n", "a.obj:2:5: texture coordinate index 2 in '1/2': 0 are defined so far"),
        ("v 0 0 0\nf 1 -2 1\n", "a.obj:2:5: vertex index -2 in '-2': 1 are defined so far"),
        ("v 0 0 0\nf 1 1.5 1\n", "a.obj:2:5: vertex index '1.5' in '1.5' is not an integer"),
        ("v 0 0 0\nf 1 1/1/1/1 1\n", "a.obj:2:5: '1/1/1/1' is not of the form v/vt/vn"),
        ("v 0 0 0\nvn 0 0 1\nff 1 1 1\n", "a.obj:3:1: unknown statement 'ff' (did you mean 'f'?)"),
        ("PK\u{3}\u{4}\n", "a.obj:1:1: unknown statement 'PK\u{fffd}\u{fffd}'"),
        ("v 0 0 0\nusemtl rde\n", "a.obj:2:8: no material library defines 'rde'"),
        ("mtllib b.mtl\n", "a.obj:1:8: material library 'b.mtl' can't be read: entity not found"),
        ("mtllib ../b.mtl\n", "a.obj:1:8: reference '../b.mtl': lies outside the scene's folder"),
        (
            "mtllib file:///etc/passwd\n",
            "a.obj:1:8: reference 'file:///etc/passwd': is a URL; only files in the scene's folder are read",
        ),
        ("v 0 0 0\nf 1 1 \\", "a.obj: the last line ends with a backslash: its statement is cut off"),
        ("", "a.obj: holds no OBJ statement: is this an OBJ file?"),
    ];
    for (text, expected) in cases {
        let message = error("a.obj", text, &[]);
        assert!(message.starts_with(expected), "\n  said     {message}\n  expected {expected}");
    }
}

#[test]
fn mtl_errors_name_line_column_and_value() {
    let cases = [
        ("newmtl a\nKd 1 1 oak\n", "b.mtl:2:8: blue 'oak' is not a number"),
        ("newmtl a\n  Kd 1 1\n", "b.mtl:2:3: Kd needs a number: its blue is missing"),
        ("newmtl a\nKd -1 0 0\n", "b.mtl:2:4: Kd -1 is not at least 0"),
        ("newmtl a\nd 2\n", "b.mtl:2:3: d 2 is not within 0 and 1"),
        ("newmtl a\nNs\n", "b.mtl:2:1: Ns needs a number: its value is missing"),
        ("Kd 1 1 1\n", "b.mtl:1:1: 'Kd' before the first newmtl"),
        ("newmtl a\nilum 2\n", "b.mtl:2:1: unknown key 'ilum' (did you mean 'illum'?)"),
        ("newmtl\n", "b.mtl:1:1: newmtl without a name"),
        ("newmtl a\nmap_Kd -bm 1\n", "b.mtl:2:1: map_Kd without a file name"),
        ("newmtl a\nmap_Kd -x 1 a.png\n", "b.mtl:2:8: unknown texture option '-x'"),
        ("newmtl a\nmap_Kd oak.png\n", "b.mtl:2:8: texture 'oak.png' can't be read: entity not found"),
        ("newmtl a\nmap_Kd c.png\n", "unsupported: c.png: neither PNG nor JPEG"),
    ];
    for (text, expected) in cases {
        let message = error("a.obj", "mtllib b.mtl\n", &[("b.mtl", text), ("c.png", "not a picture")]);
        assert!(message.starts_with(expected), "\n  said     {message}\n  expected {expected}");
    }
}

#[test]
fn ply_errors_name_line_column_and_value() {
    let head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    let cases = [
        ("solid teapot\n".into(), "c.ply:1:1: a PLY file begins with 'ply', not with 'solid teapot'"),
        ("ply\nformat asci 1.0\n".into(), "c.ply:2:8: unknown encoding 'asci' (did you mean 'ascii'?)"),
        ("ply\nformat ascii 1.0\n".into(), "c.ply:3:1: the header has no 'end_header'"),
        ("ply\nelement vertex many\n".into(), "c.ply:2:16: 'many' is not a count of elements"),
        ("ply\nelement v 1\nproperty half x\n".into(), "c.ply:3:10: unknown scalar type 'half'"),
        (format!("{head}property float x\n"), "c.ply:7:1: property 'x' of element 'vertex' is there twice"),
        (format!("{}end_header\n", head.replace("vertex 3", "vertex 1000000000000")), "limit"),
        (
            format!("{}end_header\n0 0 0\n", head.replace("vertex 3", "vertex 1000000")),
            "c.ply:8:1: the header promises 1000000 'vertex' elements of at least 6 bytes, but 6 bytes are left",
        ),
        (
            format!("{head}{face}3 0 1 3\n"),
            "c.ply:13:7: corner 2 of face 0 is vertex 3, but there are 3 vertices",
        ),
        (format!("{head}{face}3 0 1 -1\n"), "c.ply:13:7: corner 2 of face 0 is vertex -1"),
        (
            format!("{head}{face}9 0 1 2\n"),
            "c.ply:13:1: a list of 9 items, but the file holds at most 3 more",
        ),
        (format!("{head}{face}3 0 1\n"), "c.ply:13:1: a list of 3 items, but the file holds at most 2 more"),
        (
            format!("{head}end_header\n0.0000 0.0000 0.0000\n1.0000"),
            "c.ply:9:7: the file ends here, before all elements its header promises",
        ),
        (format!("{head}end_header\n0 0 0 1 zero 0 0 1 0"), "c.ply:8:9: 'zero' is not a number"),
        (format!("{head}end_header\n0 0 0 1 inf 0 0 1 0"), "c.ply:8:9: y of vertex 1 is inf, not a finite"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n".into(),
            "c.ply: vertices need x, y and z; their properties are: x",
        ),
    ];
    for (text, expected) in cases {
        let message = error("c.ply", &text, &[]);
        let holds =
            if expected == "limit" { message.contains("limit") } else { message.starts_with(expected) };
        assert!(holds, "\n  said     {message}\n  expected {expected}");
    }
}

#[test]
fn toml_errors_name_line_column_and_value() {
    let mesh = "[[mesh]]\nname = 'm'\npath = 'm.obj'\n";
    let cases = [
        (
            "[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nfov = 3\n".into(),
            "s.toml:4:1: unknown field 'fov'",
        ),
        (
            "[camera]\nposition = [0, 2e12, 1]\ntarget = [0, 0, 0]\n".into(),
            "s.toml:1:1: coordinate 2000000000000.0 of position or target is not a number within ±2^40",
        ),
        ("[camera]\nposition = [0, 0]\ntarget = [0, 0, 0]\n".into(), "s.toml:2:12: invalid length 2"),
        ("[camera]\nposition = [0, 0, 1]\n".into(), "s.toml:1:1: missing field 'target'"),
        (
            "[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 1]\n".into(),
            "s.toml:1:1: position and target are the same point [0.0, 0.0, 1.0]",
        ),
        ("[render]\nspp = -3\n".into(), "s.toml:2:7: invalid value: integer '-3'"),
        ("[render\n".into(), "s.toml:1:8: "),
        ("[[light]]\ntype = 'pont'\n".into(), "s.toml:2:8: unknown variant 'pont'"),
        ("[[light]]\ntype = 'point'\nintensity = 1\n".into(), "s.toml:1:1: a point light needs 'position'"),
        (
            "[[light]]\ntype = 'point'\nposition = [0, 0, 0]\nintensity = 1\nradius = 2\n".into(),
            "s.toml:1:1: a point light has no 'radius'; its keys are position, intensity",
        ),
        (
            "[[light]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\nradiance = 1\n".into(),
            "s.toml:1:1: radius -1 is not at least 1e-12",
        ),
        (
            "[[light]]\ntype = 'point'\nposition = [0, 0, 0]\nintensity = 'bright'\n".into(),
            "s.toml:4:13: invalid type: string \"bright\", expected a number or three numbers",
        ),
        ("[[material]]\nname = 'a'\nalbedo = 1.5\n".into(), "s.toml:1:1: albedo 1.5 is not within 0 and 1"),
        (format!("{mesh}material = 'gold'\n"), "s.toml:4:12: no [[material]] is called 'gold'"),
        (
            format!("{mesh}[[instance]]\nmesh = 'n'\n"),
            "s.toml:5:8: no mesh is called 'n' (did you mean 'm'?)",
        ),
        (
            format!("{mesh}[[instance]]\nmesh = 'm'\nscale = 0\n"),
            "s.toml:5:8: the placement flattens the mesh or is not finite (determinant 0)",
        ),
        (
            "[[mesh]]\npath = '../m.obj'\n".into(),
            "s.toml:2:8: reference '../m.obj': lies outside the scene's folder",
        ),
        (
            "[[mesh]]\npath = 'absent.obj'\n".into(),
            "s.toml:2:8: mesh file 'absent.obj' can't be read: entity not found",
        ),
        ("[[mesh]]\npath = 'm.stl'\n".into(), "unsupported: s.toml:2:8: 'm.stl': scene files end in .obj"),
        ("[[mesh]]\npath = 's.toml'\n".into(), "s.toml:2:8: 's.toml' includes itself"),
        ("[environment]\nradiance = -1\n".into(), "s.toml:1:1: radiance -1 is negative"),
        ("[environment]\nradiance = 1\nscale = inf\n".into(), "s.toml:1:1: scale inf is negative, too large"),
        ("[environment]\nscale = 2\n".into(), "s.toml:1:1: an environment needs either 'file' or 'radiance'"),
    ];
    for (text, expected) in cases {
        let message = error("s.toml", &text, &[("m.obj", "v 0 0 0\nf 1 1 1\n"), ("s.toml", &text)]);
        assert!(message.starts_with(expected), "\n  said     {message}\n  expected {expected}");
    }
}

#[test]
fn sources_that_are_no_files() {
    let said = |source: &str| load(source, &LoadOptions::default()).unwrap_err().to_string();
    assert!(said("builtin:cornel").starts_with(
        "builtin:cornel: no such builtin scene (did you mean 'cornell'?); there are: cornell, furnace"
    ));
    assert_eq!(
        said("teapot.ob"),
        "unsupported: 'teapot.ob': scene files end in .obj, .ply, .gltf, .glb, .toml (did you mean 'obj'?)"
    );
    assert!(said("nowhere/teapot.obj").starts_with("nowhere/teapot.obj: No such file"));
}
