import { element } from "../overlays/dom";
import { Notices } from "../overlays/notices";
import { createRenderer } from "../scene/graphics";
import { injectStyles } from "../styles";
import { Editor } from "./editor";
import ownStyles from "./styles.css?inline";
import { exposeForTests } from "./testing_hooks";

/** The page of the editor, connected to the server behind its address. */
function start(): void {
  injectStyles();
  document.head.append(element("style", { textContent: ownStyles }));
  const renderer = createRenderer();
  if (!renderer) {
    const notices = new Notices();
    notices.stand("graphics", {
      level: "error",
      text: "This browser offers no WebGL 2, which the picture needs.",
      remedy: "Switch on hardware acceleration in its settings, or use a current browser.",
    });
    document.body.append(element("div", { class: "bioscope" }, notices.element));
    return;
  }
  const address = new URL("stream", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  address.search = address.hash = "";
  const editor = new Editor(renderer, address.href, new URLSearchParams(location.search).get("token"));
  document.body.append(editor.root);
  exposeForTests(editor);
}

start();
