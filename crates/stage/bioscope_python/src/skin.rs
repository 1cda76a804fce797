use bioscope_core::{Error, Quat, Result, Vec3};
use bioscope_geometry::{Joint, Skin, Transform};
use numpy::PyReadonlyArray2;

use crate::arrays;

/// A joint as Python gives it: name, number of the parent, and the transform at rest in mesh space
/// (x, y, z, scale, qx, qy, qz, qw).
pub type GivenJoint = (String, Option<u8>, [f32; 8]);

/// A skin of these joints, with four joint numbers and four weights for each of `vertices` vertices;
/// weights are scaled to sum 1.
pub fn skin(
    joints: &[GivenJoint],
    indices: &PyReadonlyArray2<'_, u8>,
    weights: &PyReadonlyArray2<'_, f32>,
    vertices: usize,
) -> Result<Skin> {
    if joints.is_empty() || joints.len() > 256 {
        return Err(Error::value("joints", joints.len(), "1 to 256 joints"));
    }
    let checked = joints.iter().enumerate().map(|(number, given)| joint(number, given));
    let joints = checked.collect::<Result<Vec<_>>>()?;
    let (indices, weights) = (numbers(indices, joints.len())?, shares(weights)?);
    arrays::same_count("joint_indices", indices.len(), vertices)?;
    arrays::same_count("joint_weights", weights.len(), vertices)?;
    Ok(Skin { joints, indices, weights })
}

fn joint(number: usize, (name, parent, rest): &GivenJoint) -> Result<Joint> {
    if let Some(parent) = parent.filter(|&parent| usize::from(parent) >= number) {
        let owner = format!("parent of joints[{number}]");
        return Err(Error::value(owner, parent, "the number of an earlier joint"));
    }
    let [x, y, z, scale, qx, qy, qz, qw] = *rest;
    let rotation = Quat::from_xyzw(qx, qy, qz, qw);
    let length = rotation.length_squared();
    let whole = rest.iter().all(|one| one.is_finite()) && scale > 0.0 && length > 1e-12;
    if !whole {
        let owner = format!("rest of joints[{number}]");
        let expected = "x, y, z, scale above 0 and a quaternion xyzw, all finite";
        return Err(Error::value(owner, format!("{rest:?}"), expected));
    }
    let rest = Transform::new(Vec3::new(x, y, z), rotation.normalize(), scale);
    Ok(Joint { name: name.clone(), parent: *parent, rest })
}

fn numbers(indices: &PyReadonlyArray2<'_, u8>, joints: usize) -> Result<Vec<[u8; 4]>> {
    let array = indices.as_array();
    if array.shape()[1] != 4 {
        let found = format!("rows of {}", array.shape()[1]);
        return Err(Error::value("joint_indices", found, "shape (n, 4)"));
    }
    if let Some(index) = array.iter().find(|&&index| usize::from(index) >= joints) {
        let expected = format!("joint numbers below {joints}");
        return Err(Error::value("joint_indices", index, expected));
    }
    Ok(array.rows().into_iter().map(|row| [row[0], row[1], row[2], row[3]]).collect())
}

fn shares(weights: &PyReadonlyArray2<'_, f32>) -> Result<Vec<[f32; 4]>> {
    let rows = arrays::rows("joint_weights", weights, 4)?;
    let share = |(number, row): (usize, &[f32])| {
        let sum: f32 = row.iter().sum();
        if row.iter().any(|&weight| weight < 0.0) || sum <= 0.0 {
            let owner = format!("joint_weights[{number}]");
            return Err(Error::value(
                owner,
                format!("{row:?}"),
                "weights of at least 0, not all 0",
            ));
        }
        Ok([row[0] / sum, row[1] / sum, row[2] / sum, row[3] / sum])
    };
    rows.chunks_exact(4).enumerate().map(share).collect()
}
