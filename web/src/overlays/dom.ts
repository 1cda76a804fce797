type Child = Node | string | null | undefined;
type Properties<K extends keyof HTMLElementTagNameMap> = Partial<
  Omit<HTMLElementTagNameMap[K], "style" | "dataset">
> & {
  class?: string;
  style?: string;
  data?: Record<string, string>;
};

/** An element with properties and children. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Properties<K> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  const { class: name, style, data, ...rest } = properties;
  Object.assign(made, rest);
  if (name) made.className = name;
  if (style) made.style.cssText = style;
  Object.assign(made.dataset, data);
  made.append(...children.filter((child): child is Node | string => child != null));
  return made;
}

/** A drawn sign of 24 by 24 units, stroked in the color of the text. */
export function sign(path: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

/** What an individual is called. */
export function nameOf(species: string, id: number): string {
  return `${species.replaceAll("_", " ")} #${id}`;
}

/** Hands bytes to the browser as a file to keep. */
export function download(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  const link = element("a", { href: address, download: name });
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
