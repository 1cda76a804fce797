/** Drawn signs of the buttons, as paths in a square of 24 units. */
export const SIGNS = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M8 5v14M16 5v14",
  step: "M6 5v14l9-7zM18.5 5v14",
  back: "M18 5v14L9 12zM5.5 5v14",
  restart: "M4.5 12a7.5 7.5 0 1 0 2.4-5.5M4.5 4v4h4",
  slower: "M11 6l-6 6 6 6M19 6l-6 6 6 6",
  faster: "M5 6l6 6-6 6M13 6l6 6-6 6",
  camera: "M4 8h3l2-2.5h6L17 8h3v11H4zM12 10a3.2 3.2 0 1 0 .01 0",
  annotations: "M4 12s3-6 8-6 8 6 8 6-3 6-8 6-8-6-8-6zM12 9.5a2.5 2.5 0 1 0 .01 0",
  parameters: "M5 7h8M17 7h2M15 5v4M5 12h2M11 12h8M9 10v4M5 17h6M15 17h4M13 15v4",
  populations: "M4 19h16M5 15l4-5 4 3 6-8",
  events: "M4 6h2M9 6h11M4 12h2M9 12h11M4 18h2M9 18h11",
  numbers: "M3.5 9.5c3-4 8-4 11-.5l4-2.5v6l-4-2.5c-3 3.5-8 3.5-11-.5zM7 9.2v.1M9 19.5h7M12.5 16v7",
  layout: "M4 6l5-2 6 2 5-2v14l-5 2-6-2-5 2zM9 4v14M15 6v14",
  physics: "M3 8h3l1.5-3 3 6 3-6 3 6 1.5-3h3M4 17c2.5-2 4.5-2 7 0s4.5 2 7 0",
  behavior:
    "M9 4.5a3.5 3.5 0 0 0-3.5 4A3.5 3.5 0 0 0 5 15a3.5 3.5 0 0 0 5 3.5V6a2 2 0 0 0-1-1.5zM15 4.5a3.5 3.5 0 0 1 3.5 4A3.5 3.5 0 0 1 19 15a3.5 3.5 0 0 1-5 3.5V6a2 2 0 0 1 1-1.5z",
  habits: "M12 19.5l-6.8-6.9a4.3 4.3 0 0 1 6.1-6l.7.7.7-.7a4.3 4.3 0 0 1 6.1 6z",
  view: "M3 12s3.5-6 9-6 9 6 9 6-3.5 6-9 6-9-6-9-6zM12 9a3 3 0 1 0 .010 0M12 11.5v.8",
  share: "M8 12a2.5 2.5 0 1 1-.01 0M18 6a2.5 2.5 0 1 1-.01 0M18 18a2.5 2.5 0 1 1-.01 0M10 11l6-4M10 14l6 4",
  screenshot: "M4 5h16v14H4zM4 16l5-5 4 4 3-3 4 4M15 9h.5",
  video: "M4 7h11v10H4zM15 11l5-3v8l-5-3z",
  snapshot: "M12 4v10M8 10.5l4 4 4-4M5 19h14",
  page: "M6 3.5h8l4 4v13H6zM14 3.5v4h4M9.5 12v5l4.5-2.5z",
  help: "M9 9.2a3 3 0 1 1 4.2 2.7c-.8.4-1.2.9-1.2 1.8v.6M12 17.5v.3",
  close: "M6 6l12 12M18 6L6 18",
} as const;

export type SignName = keyof typeof SIGNS;
