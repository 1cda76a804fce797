import plotStyles from "uplot/dist/uPlot.min.css?inline";
import ownStyles from "./styles.css?inline";

const NAME = "bioscope-styles";

/** Adds the page's styles to the document, once. */
export function injectStyles(): void {
  if (document.getElementById(NAME)) return;
  const style = document.createElement("style");
  style.id = NAME;
  style.textContent = plotStyles + ownStyles;
  document.head.append(style);
}
