//! Builds small glTF files.

use serde_json::{Value, json};

/// A file being built: JSON whose first buffer is `binary`.
pub struct Builder {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl Builder {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}], "buffers": [], "bufferViews": [], "accessors": []
        });
        Self { json, binary: Vec::new() }
    }

    /// Appends to one of the JSON's lists; returns the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A view of its own with these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    /// An accessor over a view of its own.
    pub fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind}),
        )
    }

    pub fn vec3(&mut self, values: &[[f32; 3]]) -> usize {
        self.accessor("VEC3", 5126, values.len(), &floats(values.as_flattened()))
    }

    pub fn indices16(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor("SCALAR", 5123, values.len(), &bytes)
    }

    /// Adds a primitive to mesh 0.
    pub fn primitive(&mut self, primitive: Value) {
        self.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }

    /// Text with the buffer as a `data:` URI.
    pub fn gltf(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{
            "byteLength": self.binary.len(),
            "uri": format!("data:application/octet-stream;base64,{}", base64(&self.binary)),
        }]);
        json.to_string().into_bytes()
    }

    /// Binary with the buffer as a chunk.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.binary.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend(((12 + 8 + text.len() + 8 + binary.len()) as u32).to_le_bytes());
        for (kind, data) in [(b"JSON", text), (b"BIN\0", binary)] {
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend_from_slice(kind);
            bytes.extend(data);
        }
        bytes
    }
}

pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

pub fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = group.iter().fold(0_u32, |b, &x| b << 8 | u32::from(x)) << (8 * (3 - group.len()));
        for i in 0..4 {
            let sextet = (bits >> (18 - 6 * i) & 63) as usize;
            text.push(if i <= group.len() { char::from(ALPHABET[sextet]) } else { '=' });
        }
    }
    text
}

/// The unit square in the plane z = 0, as two triangles.
pub const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// A file with an indexed unit square.
pub fn square() -> Builder {
    let mut builder = Builder::new();
    let positions = builder.vec3(&SQUARE);
    let indices = builder.indices16(&[0, 1, 2, 0, 2, 3]);
    builder.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices}));
    builder
}
