/** Where a saved page keeps its recording and, for a notebook's, the code that plays it. */
const RECORDING = "bioscope-recording";
const CODE = "bioscope-code";

/** Gives the script elements that make a page of a saved recording; null if the code cannot be had. */
export type PageSource = () => Promise<string | null>;

/** The scripts of this very page: it is one file, its code stands in it. */
export const ownScript: PageSource = async () => {
  const script = document.querySelector<HTMLScriptElement>("script[type=module]:not([src])");
  const code = script?.textContent;
  return code ? `<script type="module">${code}</script>` : null;
};

/** The code of a module that a notebook has loaded, and a script that runs it. */
export function moduleScript(address: string): PageSource {
  return async () => {
    const code = await fetch(address).then(
      (answer) => (answer.ok ? answer.text() : null),
      () => null,
    );
    if (code === null) return null;
    const start = `const code = document.getElementById("${CODE}").textContent;
const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
(await import(address)).playSaved(document.body);`;
    const safe = code.replaceAll("</script", "<\\/script");
    return `<script type="text/plain" id="${CODE}">${safe}</script><script type="module">${start}</script>`;
  };
}

/** A page that plays a recording by itself, without any network. */
export async function createPage(title: string, recording: Uint8Array, scripts: string): Promise<Blob> {
  const packed = await repack(recording, new CompressionStream("gzip"));
  const safe = title.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
  const head = `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>${safe}</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">
<style>html,body{height:100%;margin:0;background:#04121c}</style></head><body>
<script type="text/plain" id="${RECORDING}">`;
  return new Blob([head, toBase64(packed), "</script>", scripts, "</body></html>"], { type: "text/html" });
}

/** The recording that this page carries; null if it is a live page. */
export async function carriedRecording(): Promise<Uint8Array | null> {
  const text = document.getElementById(RECORDING)?.textContent;
  if (!text) return null;
  return repack(fromBase64(text), new DecompressionStream("gzip"));
}

async function repack(
  bytes: Uint8Array,
  stream: CompressionStream | DecompressionStream,
): Promise<Uint8Array> {
  const through = new Blob([bytes as BlobPart]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(through).arrayBuffer());
}

export function toBase64(bytes: Uint8Array): string {
  const parts: string[] = [];
  const length = 3 * 8192; // a multiple of three, so that parts can be joined
  for (let i = 0; i < bytes.length; i += length) {
    parts.push(btoa(String.fromCharCode(...bytes.subarray(i, i + length))));
  }
  return parts.join("");
}

export function fromBase64(text: string): Uint8Array {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}
