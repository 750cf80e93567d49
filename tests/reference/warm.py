"""The program from a process that has its libraries loaded: each call is a process of its own, forked from that one.

Loading SciPy, Taichi and matplotlib is most of what a short command costs. ``serve`` has done it, and has run no
kernel, which would not survive a fork. A call sends its words, folder and open files, and gets the exit code.
"""

import contextlib
import importlib
import json
import os
import signal
import socket
import sys
from pathlib import Path
from types import FrameType

HEAVY = (
    "numpy", "scipy.sparse.linalg", "scipy.spatial", "scipy.optimize", "scipy.integrate", "scipy.interpolate",
    "matplotlib.figure", "matplotlib.backends.backend_agg", "PIL.Image", "plyfile", "networkx", "rich.console",
    "tiskel.pipeline", "tiskel.viewer.show", "tiskel.report.page", "tiskel.metrics.evaluate", "tiskel.rolling.plan",
    "tiskel.io.anything", "tiskel.cli.app", "ripser", "taichi", "tiskel.kernels.rings", "tiskel.kernels.cones",
)  # fmt: skip
CALL = """#!{python} -ISE
import json, os, socket, sys
s = socket.socket(socket.AF_UNIX)
s.connect({address!r})
words = json.dumps([sys.argv[1:], os.getcwd(), dict(os.environ)]).encode()
socket.send_fds(s, [len(words).to_bytes(4, "big")], [0, 1, 2])
s.sendall(words)
code = s.recv(1)
os._exit(code[0] if code else 1)
"""


def serve(address: str) -> None:
    """Answer calls until the process is ended."""
    os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")
    for name in HEAVY:
        importlib.import_module(name)
    signal.signal(signal.SIGCHLD, _reap)
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(address)
    listener.listen()
    while True:
        call, _ = listener.accept()
        if os.fork() == 0:
            listener.close()
            _answer(call)
        call.close()


def _reap(signum: int, frame: FrameType | None) -> None:
    with contextlib.suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def _answer(call: socket.socket) -> None:
    """Run one call in this process, which ends with it."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    head, files, _, _ = socket.recv_fds(call, 4, 3)
    words = b""
    while len(words) < int.from_bytes(head, "big"):
        words += call.recv(65536)
    argv, folder, environment = json.loads(words)
    for target, source in enumerate(files):
        os.dup2(source, target)
        os.close(source)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = ["tiskel", *argv]
    call.sendall(bytes([_code()]))
    os._exit(0)


def _code() -> int:
    from tiskel.cli.app import main

    try:
        main()
    except SystemExit as stop:
        code = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
    else:
        code = 0
    sys.stdout.flush()
    sys.stderr.flush()
    return code


def caller(folder: Path, address: str) -> None:
    """Write a program ``tiskel`` into a folder that sends its calls to an address."""
    program = folder / "tiskel"
    program.write_text(CALL.format(python=sys.executable, address=address))
    program.chmod(0o755)


if __name__ == "__main__":
    serve(sys.argv[1])
