import {
  DepthTexture,
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  UnsignedIntType,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import type { Quality } from "./quality";

/** A renderer on a new canvas; null if the browser offers no WebGL 2. */
export function createRenderer(): WebGLRenderer | null {
  const canvas = document.createElement("canvas");
  const attributes = { antialias: false, alpha: false, powerPreference: "high-performance" as const };
  const context = canvas.getContext("webgl2", attributes) as WebGL2RenderingContext | null;
  if (!context) return null;
  try {
    const renderer = new WebGLRenderer({ canvas, context });
    renderer.autoClear = false;
    return renderer;
  } catch {
    return null;
  }
}

/** Where the scene is drawn in linear light before it is developed for the screen. */
export function createPicture(width: number, height: number, quality: Quality): WebGLRenderTarget {
  return new WebGLRenderTarget(width, height, {
    type: HalfFloatType,
    samples: quality.samples,
    depthTexture: new DepthTexture(width, height, UnsignedIntType),
    generateMipmaps: quality.halo,
    minFilter: quality.halo ? LinearMipmapLinearFilter : LinearFilter,
    magFilter: LinearFilter,
  });
}

/** Whether the browser computes pictures without a graphics processor. */
export function isSoftware(renderer: WebGLRenderer): boolean {
  const context = renderer.getContext();
  const details = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(details ? details.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
