// What the page's modules meet that they do not define, for the check of their types (`./dev check`).

declare const Chart: any; // Chart.js, which the page serves beside them

interface Window { // for whoever looks at it with the browser's tools
  shakenBeside: any;
  shakenRods: any;
  shakenRun: any;
  shakenSweep: any;
}

interface EventTarget { // of events of the keyboard and the mouse, which elements get
  closest?(selectors: string): HTMLElement | null;
}

interface Element {
  setAttribute(name: string, value: boolean): void; // which is written as a word
}
