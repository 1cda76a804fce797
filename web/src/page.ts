import { Playback } from "./messages/playback";
import { Socket } from "./messages/socket";
import { carriedRecording, ownScript } from "./share/page_copy";
import { startViewer } from "./start";

/** The page: plays the recording it carries, else shows the world behind its address. */
async function start(): Promise<void> {
  const recording = await carriedRecording();
  const address = new URL("stream", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  address.search = address.hash = "";
  const token = new URLSearchParams(location.search).get("token");
  const transport = recording ? new Playback(recording) : new Socket(address.href, token);
  startViewer(document.body, transport, ownScript);
}

void start();
