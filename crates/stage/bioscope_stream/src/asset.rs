use bioscope_geometry::{Material, Mesh, Texture};
use bytemuck::cast_slice;
use serde::Serialize;
use serde_bytes::{ByteBuf, Bytes};

use crate::quantize;

#[derive(Serialize)]
struct MeshMessage<'a> {
    r#type: &'static str,
    key: u64,
    r#box: [f32; 6],
    positions: ByteBuf,
    normals: ByteBuf,
    uvs: Option<&'a Bytes>,
    brightest: f32,
    colors: Option<ByteBuf>,
    triangles: Option<&'a Bytes>,
    short_triangles: Option<ByteBuf>,
    levels: Vec<(f32, u64)>,
    #[serde(flatten)]
    skin: Option<SkinMessage<'a>>,
}

#[derive(Serialize)]
struct SkinMessage<'a> {
    parents: ByteBuf,
    rest: ByteBuf,
    joint_indices: &'a Bytes,
    joint_weights: ByteBuf,
}

/// The message that describes a mesh.
pub fn mesh(mesh: &Mesh) -> Vec<u8> {
    let skin = mesh.skin.as_ref().map(|skin| {
        let parent = |joint: &bioscope_geometry::Joint| joint.parent.map_or(-1_i8, |one| one as i8);
        let parents: Vec<u8> = skin.joints.iter().map(|joint| parent(joint) as u8).collect();
        let rest: Vec<_> = skin.joints.iter().map(|joint| joint.rest).collect();
        let weights = skin.weights.iter().flatten().map(|weight| (weight * 255.0).round() as u8);
        SkinMessage {
            parents: parents.into(),
            rest: cast_slice::<_, u8>(&rest).to_vec().into(),
            joint_indices: Bytes::new(cast_slice(&skin.indices)),
            joint_weights: weights.collect::<Vec<u8>>().into(),
        }
    });
    let (low, high) = quantize::bounds(mesh.positions.iter().copied());
    let colors = || mesh.colors.iter().flatten().copied();
    let brightest = colors().fold(1e-6, f32::max);
    let step = 65535.0 / brightest;
    let colors = colors().flat_map(|part| ((part * step).round() as u16).to_le_bytes());
    let colors: Vec<u8> = colors.collect();
    let is_small = mesh.positions.len() <= 65536;
    let short = || mesh.triangles.iter().flatten().flat_map(|&one| (one as u16).to_le_bytes());
    encode(&MeshMessage {
        r#type: "mesh",
        key: mesh.key.number(),
        r#box: [low.x, low.y, low.z, high.x, high.y, high.z],
        positions: quantize::points(mesh.positions.iter().copied(), low, high).into(),
        normals: quantize::directions(&mesh.normals).into(),
        uvs: present(cast_slice(&mesh.uvs)),
        brightest,
        colors: (!colors.is_empty()).then(|| colors.into()),
        triangles: (!is_small).then(|| Bytes::new(cast_slice(&mesh.triangles))),
        short_triangles: is_small.then(|| short().collect::<Vec<u8>>().into()),
        levels: mesh.levels.iter().map(|(size, level)| (*size, level.key.number())).collect(),
        skin,
    })
}

fn present(bytes: &[u8]) -> Option<&Bytes> {
    (!bytes.is_empty()).then(|| Bytes::new(bytes))
}

#[derive(Serialize)]
struct TextureMessage {
    r#type: &'static str,
    key: u64,
    width: u32,
    height: u32,
    png: ByteBuf,
}

/// The message that carries a texture as a PNG file.
pub fn texture(texture: &Texture) -> Vec<u8> {
    encode(&TextureMessage {
        r#type: "texture",
        key: texture.key.number(),
        width: texture.width,
        height: texture.height,
        png: png(texture.width, texture.height, cast_slice(&texture.pixels)).into(),
    })
}

/// RGBA pixels as the bytes of a PNG file.
fn png(width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().expect("writing to memory succeeds");
    writer.write_image_data(pixels).expect("a texture has as many pixels as it says");
    drop(writer);
    bytes
}

#[derive(Serialize)]
struct MaterialMessage<'a> {
    r#type: &'static str,
    key: u64,
    name: &'a str,
    color: [f32; 3],
    texture: Option<u64>,
    cutout: bool,
    roughness: f32,
    specular: f32,
    translucency: f32,
    opacity: f32,
    two_sided: bool,
}

/// The message that describes a material.
pub fn material(material: &Material) -> Vec<u8> {
    encode(&MaterialMessage {
        r#type: "material",
        key: material.key.number(),
        name: &material.name,
        color: material.color,
        texture: material.texture.as_ref().map(|texture| texture.key.number()),
        cutout: material.cutout,
        roughness: material.roughness,
        specular: material.specular,
        translucency: material.translucency,
        opacity: material.opacity,
        two_sided: material.two_sided,
    })
}

/// A message as MessagePack with named fields.
pub fn encode<T: Serialize>(message: &T) -> Vec<u8> {
    rmp_serde::to_vec_named(message).expect("plain data encodes to memory")
}
