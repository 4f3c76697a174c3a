// The session with the program: messages in both directions, and a new connection after a lost one.

const retrySeconds = [0.3, 0.6, 1, 2, 3, 5];
const busyBytes = 1 << 16; // more than that waits to be sent: gestures are added up meanwhile

export class Connection extends EventTarget {
  #socket = null;
  #id = 0;
  #attempts = 0;
  #timer = 0;

  /// `hear(message)` gets each text as an object, `see(buffer)` each picture.
  constructor(token, {hear, see}) {
    super();
    this.token = token;
    this.hear = hear;
    this.see = see;
    addEventListener('online', () => this.connectNow());
    document.addEventListener('visibilitychange', () => document.hidden || this.connectNow());
  }

  address(path) {
    return `${path}?token=${encodeURIComponent(this.token)}`;
  }

  get isOpen() { return this.#socket?.readyState === WebSocket.OPEN; }
  get isBusy() { return !this.isOpen || this.#socket.bufferedAmount > busyBytes; }
  get attempts() { return this.#attempts; }

  connect() {
    const address = new URL(this.address('session'), location.href);
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address, 'limpid');
    this.#socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.addEventListener('open', () => {
      this.#attempts = 0;
      this.dispatchEvent(new Event('open'));
    });
    socket.addEventListener('message', ({data}) => {
      if (typeof data === 'string') this.hear(JSON.parse(data));
      else this.see(data);
    });
    socket.addEventListener('close', () => this.#socket === socket && this.lost());
  }

  lost() {
    this.#socket = null;
    const seconds = retrySeconds[Math.min(this.#attempts++, retrySeconds.length - 1)];
    this.#timer = setTimeout(() => this.connect(), 1000 * seconds);
    this.dispatchEvent(new Event('lost'));
  }

  /// Without the rest of the wait, if there is one.
  connectNow() {
    if (this.#socket) return;
    clearTimeout(this.#timer);
    this.connect();
  }

  send(type, content = {}) {
    if (this.isOpen) this.#socket.send(JSON.stringify({type, ...content}));
  }

  /// The same with an id, which the server's `ack` names; it is returned.
  sendNumbered(type, content) {
    this.send(type, {...content, id: ++this.#id});
    return this.#id;
  }
}
