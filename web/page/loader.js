/** Does one thing at a time: `act(wish)`. Of what is wished for meanwhile only the newest is done. */
export class Newest {
  isBusy = false;
  wish = null;

  constructor(act) { this.act = act; }

  async want(wish) {
    this.wish = wish;
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      while (this.wish !== null) {
        const now = this.wish;
        this.wish = null;
        await this.act(now);
      }
    } finally {
      this.isBusy = false;
    }
  }
}

/**
 * Calls `load` when it is wanted: never two at a time, once more if it was wanted meanwhile, and with at least `pause` ms,
 * or as long as a load takes, between two of them.
 */
export class Loader extends Newest {
  constructor(load, pause = 1000) {
    super(async () => {
      const begin = performance.now();
      ++this.n;
      await load();
      await new Promise((done) => setTimeout(done, Math.max(pause, performance.now() - begin)));
    });
    this.n = 0;
  }

  want() { return super.want(true); }
}
