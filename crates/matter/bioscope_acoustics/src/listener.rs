use bioscope_core::{Error, Quat, Result, Vec3};

/// Above this speed in metres per second a step from pose to pose is taken for a cut.
const FASTEST_LISTENER: f64 = 100.0;

/// Where a listener is and how it is turned at one instant; it looks along -Z, as cameras do, so
/// that its right is +X.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListenerPose {
    /// World time in seconds.
    pub time: f64,
    /// Position in metres.
    pub position: Vec3,
    /// Rotation from the listener's frame to the world's.
    pub rotation: Quat,
}

/// The way of a listener: shots, within which it moves smoothly, and cuts between them, over which
/// sounds are cross-faded and nothing is heard to rush by.
///
/// Before its first pose a listener rests there, after its last pose as well. A path may grow
/// while it is being used, as long as it stays the same path.
#[derive(Clone, Debug, PartialEq)]
pub struct ListenerPath {
    poses: Vec<ListenerPose>,
    /// Index of the first pose of each shot; the first is 0.
    shots: Vec<usize>,
}

impl ListenerPath {
    /// A path that begins, and so far stays, at one pose.
    pub fn starting(pose: ListenerPose) -> Result<Self> {
        Ok(Self { poses: vec![checked(pose)?], shots: vec![0] })
    }

    /// Moves on to a later pose. A step faster than 100 m/s, or none in time, is taken for a cut.
    pub fn push(&mut self, pose: ListenerPose) -> Result<()> {
        let last = *self.last();
        let way = f64::from(last.position.distance(pose.position));
        let is_cut = way > FASTEST_LISTENER * (pose.time - last.time);
        if is_cut { self.cut(pose) } else { self.append(pose) }
    }

    /// Jumps to a later pose: the first of a new shot.
    pub fn cut(&mut self, pose: ListenerPose) -> Result<()> {
        self.append(pose)?;
        self.shots.push(self.poses.len() - 1);
        Ok(())
    }

    fn append(&mut self, pose: ListenerPose) -> Result<()> {
        let pose = checked(pose)?;
        let last = self.last().time;
        if pose.time < last {
            return Err(Error::value("listener.time", pose.time, format!("{last} s or later")));
        }
        self.poses.push(pose);
        Ok(())
    }

    fn last(&self) -> &ListenerPose {
        &self.poses[self.poses.len() - 1]
    }

    /// Number of the shot that is on at this time.
    pub(crate) fn shot_at(&self, time: f64) -> usize {
        let begun = self.shots.partition_point(|&first| self.poses[first].time <= time);
        begun.saturating_sub(1)
    }

    /// The pose at this time within one shot, held at the shot's first and last pose.
    pub(crate) fn pose_in(&self, shot: usize, time: f64) -> ListenerPose {
        let shot = shot.min(self.shots.len() - 1);
        let end = self.shots.get(shot + 1).copied().unwrap_or(self.poses.len());
        let poses = &self.poses[self.shots[shot]..end];
        let later = poses.partition_point(|pose| pose.time <= time);
        if later == 0 || later == poses.len() {
            return ListenerPose { time, ..poses[later.saturating_sub(1)] };
        }
        let (a, b) = (&poses[later - 1], &poses[later]);
        let share = ((time - a.time) / (b.time - a.time)) as f32;
        ListenerPose {
            time,
            position: a.position.lerp(b.position, share),
            rotation: a.rotation.lerp(b.rotation, share),
        }
    }
}

/// The pose with a unit rotation, if all its numbers make sense.
fn checked(pose: ListenerPose) -> Result<ListenerPose> {
    if !pose.time.is_finite() {
        return Err(Error::value("listener.time", pose.time, "a finite number of seconds"));
    }
    if !(pose.position.is_finite() && pose.position.abs().max_element() <= 1e9) {
        let expected = "finite coordinates up to 1e9";
        return Err(Error::value("listener.position", pose.position, expected));
    }
    let length = pose.rotation.length();
    if !(length.is_finite() && length > 1e-6) {
        return Err(Error::value("listener.rotation", pose.rotation, "a rotation"));
    }
    Ok(ListenerPose { rotation: pose.rotation * (1.0 / length), ..pose })
}
