// Reads a file without pictures with three.js, goes to a time of its animation, and prints, as JSON, the
// world positions of all vertices by the name of the object.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [web, path, time] = process.argv.slice(2);
globalThis.self = globalThis;
const three = (file) => import(pathToFileURL(`${web}/node_modules/three/${file}`).href);
const { AnimationMixer, Vector3 } = await three("build/three.module.js");
const { GLTFLoader } = await three("examples/jsm/loaders/GLTFLoader.js");

const bytes = readFileSync(path);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
const gltf = await new GLTFLoader().parseAsync(buffer, "");
const mixer = new AnimationMixer(gltf.scene);
for (const clip of gltf.animations) mixer.clipAction(clip).play();
mixer.setTime(Number(time));
gltf.scene.updateMatrixWorld(true);

const found = [];
gltf.scene.traverse((object) => {
  if (!object.isMesh) return;
  const vertices = [];
  for (let index = 0; index < object.geometry.attributes.position.count; index++) {
    const point = object.getVertexPosition(index, new Vector3());
    vertices.push(point.applyMatrix4(object.matrixWorld).toArray());
  }
  const instances = object.isInstancedMesh ? object.count : 1;
  const { id } = object.userData;
  found.push({ name: object.name, parent: object.parent.name, id, instances, vertices });
});
console.log(JSON.stringify(found));
