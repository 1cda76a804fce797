import { Notebook, type WidgetModel } from "./messages/notebook";
import { Playback } from "./messages/playback";
import { carriedRecording, moduleScript } from "./share/page_copy";
import { startViewer } from "./start";

/** The live view in a notebook, for anywidget. */
function render({ model, el }: { model: WidgetModel; el: HTMLElement }): () => void {
  el.style.cssText = `position: relative; height: ${model.get("height")}px; background: #04121c`;
  return startViewer(el, new Notebook(model), moduleScript(import.meta.url));
}

/** Plays the recording that a page saved from a notebook carries. */
export async function playSaved(element: HTMLElement): Promise<void> {
  const recording = await carriedRecording();
  if (recording) startViewer(element, new Playback(recording), moduleScript(import.meta.url));
}

export default { render };
