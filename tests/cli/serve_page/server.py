"""The program, and a network between it and the browser."""

import pathlib
import re
import signal
import socket
import subprocess
import threading

from browser import check

SCENE = 'builtin:cornell'
SAMPLES = 4


class Server:
    """`limpid serve`, always at the same port."""

    def __init__(self, program, folder):
        self.program, self.port, self.process = program, 0, None
        # The exposure would be measured in the first frame, whose size is another one in the window.
        self.state = pathlib.Path(folder) / 'state.json'
        self.state.write_text('{"limpid_state": 1, "exposure": 1.5}')

    def options(self):
        return [SCENE, '--device', 'cpu', '--max-spp', str(SAMPLES), '--state', str(self.state)]

    def start(self, *options):
        self.process = subprocess.Popen(
            [self.program, 'serve', *self.options(), '--port', str(self.port), *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.stderr.read())
        self.port = int(re.search(r':(\d+)/', self.address).group(1))

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(30)
        check(code == 0, f'limpid serve ends with {code}: {self.process.stderr.read()}')


class Relay:
    """Stands between the browser and the program, as a network that can be cut."""

    def __init__(self, server):
        self.server, self.open, self.sockets = server, True, set()
        self.listener = socket.create_server(('127.0.0.1', 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def address(self):
        return self.server.address.replace(f':{self.server.port}/', f':{self.port}/')

    def accept(self):
        while True:
            near, _ = self.listener.accept()
            try:
                far = socket.create_connection(('127.0.0.1', self.server.port)) if self.open else None
            except OSError:
                far = None
            if not far:
                near.close()
                continue
            self.sockets |= {near, far}
            for source, target in ((near, far), (far, near)):
                threading.Thread(target=self.forward, args=(source, target), daemon=True).start()

    def forward(self, source, target):
        try:
            while data := source.recv(1 << 16):
                target.sendall(data)
        except OSError:
            pass
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # it is closed

    def cut(self):
        self.open = False
        for end in list(self.sockets):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # it is closed
        self.sockets.clear()
