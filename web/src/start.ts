import type { Transport } from "./messages/transport";
import { element } from "./overlays/dom";
import { Notices } from "./overlays/notices";
import { createRenderer } from "./scene/graphics";
import type { PageSource } from "./share/page_copy";
import { injectStyles } from "./styles";
import { exposeForTests } from "./testing_hooks";
import { Viewer } from "./viewer";

/** Starts the live view in an element, or says why it cannot; gives what stops it. */
export function startViewer(host: HTMLElement, transport: Transport, source: PageSource): () => void {
  const renderer = createRenderer();
  if (renderer) {
    const viewer = new Viewer(host, renderer, transport, source);
    exposeForTests(viewer);

    viewer.start();
    return () => viewer.stop();
  }
  injectStyles();
  const notices = new Notices();
  notices.stand("graphics", {
    level: "error",
    text: "This browser offers no WebGL 2, which the picture needs.",
    remedy:
      "Switch on hardware acceleration in its settings, or use a current Chrome, Edge, Firefox or Safari.",
  });
  const root = element("div", { class: "bioscope" }, notices.element);
  host.append(root);
  return () => root.remove();
}
