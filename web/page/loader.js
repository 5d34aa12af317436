// SPDX-License-Identifier: MIT

/**
 * Calls `load` when it is wanted: never two at a time, once more if it was wanted meanwhile, and with at least `pause` ms,
 * or as long as a load takes, between two of them.
 */
export class Loader {
  constructor(load, pause = 1000) {
    Object.assign(this, {load, pause, isBusy: false, isWanted: false, n: 0});
  }

  async want() {
    this.isWanted = true;
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      while (this.isWanted) {
        this.isWanted = false;
        const begin = performance.now();
        ++this.n;
        await this.load();
        await new Promise((done) => setTimeout(done, Math.max(this.pause, performance.now() - begin)));
      }
    } finally {
      this.isBusy = false;
    }
  }
}
