import { download, element } from "../overlays/dom";
import type { Viewer } from "../viewer";
import { toggle } from "./slider";
import { formatView, parseView } from "./view_file";

/** Switches of what is drawn, and files of where one looks from. */
export function drawingControls(viewer: Viewer): HTMLElement {
  const labels = toggle("labels", "the number of every animal", (on) => {
    viewer.marks.labels = on;
    labels.show(on);
  });
  const wireframe = toggle("wireframe", "the edges of all triangles instead of surfaces", (on) => {
    viewer.stage.wireframe = on;
    wireframe.show(on);
  });
  const file = element("input", { type: "file", accept: ".json", hidden: true });
  file.onchange = async () => {
    const chosen = file.files?.[0];
    file.value = "";
    if (chosen) loadView(viewer, chosen.name, await chosen.text());
  };
  const button = (textContent: string, title: string, onclick: () => void) =>
    element("button", { textContent, title, onclick });
  return element(
    "div",
    {},
    element("div", { class: "bio-row" }, labels.element, wireframe.element),
    element(
      "div",
      { class: "bio-row" },
      button("save view", "from where one looks, as a file", () => saveView(viewer)),
      button("load view", "look from where a file says", () => file.click()),
      file,
    ),
    element(
      "div",
      { class: "bio-row" },
      button("save picture (P)", "what is on the screen, as an image", () => viewer.saveScreenshot()),
    ),
  );
}

function saveView(viewer: Viewer): void {
  const view = viewer.keeping.view();
  download("view.json", new Blob([formatView(view)], { type: "application/json" }));
}

function loadView(viewer: Viewer, name: string, text: string): void {
  const view = parseView(text);
  if (!view) {
    viewer.notices.tell({
      level: "error",
      text: `${name} is not the file of a view.`,
      remedy: "Save one from this panel.",
    });
    return;
  }
  viewer.cameras.lookFrom(view.eye, view.target);
  if (view.camera !== "free") viewer.cameras.use(view.camera);
}
