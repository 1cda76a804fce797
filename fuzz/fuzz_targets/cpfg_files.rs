//! Any bytes as one of the files beside a cpfg model: read or refused, and what was read can be used.

#![no_main]

use bioscope_lsystem::{
    Animation, ContourShape, Curve, EnvironmentFile, Function, SurfaceShape, View, read_color_map,
    read_materials,
};
use libfuzzer_sys::fuzz_target;

const SAMPLES: usize = 50;

fuzz_target!(|bytes: &[u8]| {
    let _ = read_color_map(bytes, "fuzz.map");
    let _ = read_materials(bytes, "fuzz.mat");
    let _ = EnvironmentFile::parse(bytes, "fuzz.e");
    if let Ok(animation) = Animation::parse(bytes, "fuzz.a") {
        assert!(animation.frames(100).len() <= 1_000_000);
    }
    if let Ok(function) = Function::parse(bytes, "fuzz.func", SAMPLES) {
        function.value(0.5);
    }
    for function in Function::parse_set(bytes, "fuzz.fset").unwrap_or_default() {
        function.value(f64::NAN);
    }
    if let Ok(contour) = ContourShape::parse(bytes, "fuzz.con") {
        assert_eq!(contour.sampled(12).len(), 13);
    }
    let _ = Curve::parse(bytes, "fuzz.crv", SAMPLES);
    if let Ok(surface) = SurfaceShape::parse(bytes, "fuzz.s", 1.0) {
        let count = surface.mesh.positions.len() as u32;
        assert!(surface.mesh.triangles.as_flattened().iter().all(|&corner| corner < count));
    }
    // Every file that a view names is the view itself.
    if let Ok(view) = View::parse(bytes, "fuzz.v", &|_| Ok(bytes.to_vec())) {
        assert!(view.sides >= 1);
    }
});
