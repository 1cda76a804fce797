import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { FilmCamera } from "../src/camera/film";
import { facing, RigCamera, relaxation, standing } from "../src/camera/rig";
import type { Scenery, Viewpoint } from "../src/camera/viewpoint";
import { backoff } from "../src/messages/socket";
import type { Rig } from "../src/messages/types";
import { refracted } from "../src/scene/shared_uniforms";

const view = (): Viewpoint => ({ position: new Vector3(), rotation: new Quaternion(), fieldOfView: 1 });
const orbit: Rig = {
  name: "round",
  kind: "orbit",
  target: [1, 2, 3],
  radius: 5,
  height: 2,
  period: 40,
  field_of_view: 0.7,
};

/** A stage with one animal that is one metre long and looks along +X. */
function sceneryWith(time: number, dt: number, position = [0, 0, 0]): Scenery {
  const turned = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), Math.PI / 2);
  const place = new Float32Array([...position, 1, ...turned.toArray()]);
  const batch = {
    layout: { species: "cod", count: 1, ids: new Uint32Array([5]) },
    asset: { box: [-0.1, -0.1, -0.5, 0.1, 0.1, 0.5] },
    placeOf: () => place,
  };
  const stage = {
    batches: new Map([["cod", batch]]),
    find: (id: number) => (id === 5 ? { batch, slot: 0 } : null),
  };
  return { stage, time, dt, selected: 0 } as unknown as Scenery;
}

describe("camera rigs", () => {
  it("look at their target with the camera's −Z", () => {
    const rotation = facing(new Vector3(0, 0, 5), new Vector3(0, 0, -1));
    const ahead = new Vector3(0, 0, -1).applyQuaternion(rotation);
    expect(ahead.z).toBeCloseTo(-1);
    const camera = new PerspectiveCamera();
    camera.position.set(2, 1, 3);
    camera.lookAt(0, 0, 0);
    expect(facing(camera.position, new Vector3()).angleTo(camera.quaternion)).toBeLessThan(1e-6);
  });

  it("orbit at their radius and height, once per period", () => {
    const start = standing(orbit, 0).position;
    expect(start.toArray()).toEqual([1, 4, 8]);
    expect(standing(orbit, 10).position.x).toBeCloseTo(6);
    expect(standing(orbit, 40).position.distanceTo(start)).toBeLessThan(1e-6);
  });

  it("follow late: the first time at once, then by the lag", () => {
    const rig = new RigCamera({
      name: "chase",
      kind: "follow",
      species: "cod",
      index: 0,
      offset: [0, 0, -3],
      field_of_view: 0.7,
    });
    const at = view();
    expect(rig.update(at, sceneryWith(0, 0.1))).toBeNull();
    expect(at.position.x).toBeCloseTo(-3); // behind an animal that looks along +X
    rig.update(at, sceneryWith(0.1, 0.1, [1, 0, 0]));
    expect(at.position.x).toBeCloseTo(-3 + relaxation(0.1, 0.9), 4);
  });

  it("say what is missing", () => {
    const rig = new RigCamera({
      name: "chase",
      kind: "follow",
      species: "eel",
      index: 0,
      field_of_view: 0.7,
    });
    expect(rig.update(view(), sceneryWith(0, 0.1))).toContain("eel");
  });

  it("are cut by the world's shot list", () => {
    const fixed: Rig = {
      name: "still",
      kind: "fixed",
      position: [0, 0, 9],
      target: [0, 0, 0],
      field_of_view: 0.5,
    };
    const film = new FilmCamera(
      [orbit, fixed],
      [
        ["still", 2],
        ["gone", 9],
        ["round", 3],
      ],
    );
    const at = view();
    film.enter();
    film.update(at, sceneryWith(0, 1.5));
    expect(at.fieldOfView).toBe(0.5);
    film.update(at, sceneryWith(0, 1));
    expect(at.fieldOfView).toBe(0.7);
  });
});

describe("light and link", () => {
  it("bends the sun's rays towards the vertical by Snell's law", () => {
    const sun = new Vector3(Math.sin(1), Math.cos(1), 0);
    const below = refracted(sun);
    expect(below.length()).toBeCloseTo(1);
    expect(below.x * 1.34).toBeCloseTo(sun.x, 5);
  });

  it("waits longer from attempt to attempt, but never too long", () => {
    expect([0, 1, 2, 10].map(backoff)).toEqual([0.5, 1, 2, 8]);
  });
});
