"""A plain client of `skiagraph live`: WebSocket (RFC 6455) by sockets alone."""
import base64
import hashlib
import json
import os
import socket
import struct
import subprocess
import time
import urllib.parse

LIMIT = 120  # seconds that anything may take before it is a failure
HEADER = struct.Struct("<4sIIHHdddfHBB")  # skg_live_header of host/live/plans.h


class Frame:
    """An image as pages receive it."""

    def __init__(self, data, wanted=b"SKLF"):
        (mark, self.number, self.wish, self.columns, self.rows, self.low, self.step, self.flat, self.ms, self.factor,
         self.quantity, self.notes) = HEADER.unpack_from(data)
        assert mark == wanted
        self.numbers = struct.unpack_from(f"<{self.columns * self.rows}H", data, HEADER.size)
        assert len(data) == HEADER.size + 2 * self.columns * self.rows

    def value(self, column, row):
        return self.low + self.step * self.numbers[row * self.columns + column]


class Server:
    """The command, running."""

    def __init__(self, command, *words, desktop=None):
        """desktop: variables of a desktop, where a browser opens the page"""
        self.process = subprocess.Popen([command, "live", *words, *([] if desktop else ["--no-open"])], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, env={**os.environ, **(desktop or {})})
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise RuntimeError(self.process.stderr.read())
        parts = urllib.parse.urlsplit(self.url)
        self.port, self.token = parts.port, urllib.parse.parse_qs(parts.query)["token"][0]

    def get(self, path, headers=(), method="GET", host=None, limit=LIMIT):
        """Status and text of an answer. host: "" for none"""
        with socket.create_connection(("127.0.0.1", self.port), timeout=limit) as connection:
            named = [] if host == "" else [f"Host: {host or f'127.0.0.1:{self.port}'}"]
            lines = [f"{method} {path} HTTP/1.1", *named, "Connection: close", *headers, "", ""]
            connection.sendall("\r\n".join(lines).encode())
            data = b""
            while chunk := connection.recv(1 << 16):
                data += chunk
        return int(data.split()[1]), data.decode("utf-8", "replace")

    def processor_seconds(self):
        """Time that processors have worked for it."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self):
        """Resident memory, in MiB."""
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20

    def end(self, timeout=LIMIT):
        """Exit status after Ctrl-C."""
        self.process.send_signal(2)
        return self.process.wait(timeout)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class Socket:
    """A WebSocket."""

    def __init__(self, port, path, origin=None, receive_buffer=None):
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(LIMIT)
        self.socket.connect(("127.0.0.1", port))
        lines = [f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin:
            lines.append(f"Origin: {origin}")
        self.socket.sendall("\r\n".join([*lines, "", ""]).encode())
        self.rest = b""
        head = self.until(b"\r\n\r\n")
        self.status = int(head.split()[1])
        if self.status == 101:
            proof = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest())
            assert proof in head

    def until(self, end):
        while end not in self.rest:
            chunk = self.socket.recv(1 << 16)
            if not chunk:
                break
            self.rest += chunk
        head, _, self.rest = self.rest.partition(end)
        return head

    def exactly(self, count):
        pieces, have = [self.rest], len(self.rest)
        while have < count:
            chunk = self.socket.recv(1 << 20)
            if not chunk:
                raise EOFError
            pieces.append(chunk)
            have += len(chunk)
        data = b"".join(pieces)
        self.rest = data[count:]
        return data[:count]

    def send_raw(self, code, data, fin=True):
        mask, size = os.urandom(4), len(data)
        head = bytes([(0x80 if fin else 0) | code])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 1 << 16:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        self.socket.sendall(head + mask + bytes(byte ^ mask[i & 3] for i, byte in enumerate(data)))

    def send(self, message):
        self.send_raw(1, json.dumps(message).encode())

    def receive_raw(self):
        """Code and data of the next message, whose pieces are joined."""
        whole, kind = b"", 0
        while True:
            first, second = self.exactly(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self.exactly(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.exactly(8))[0]
            data, code = self.exactly(size), first & 15
            if code == 8:
                raise EOFError
            if code > 2:
                continue
            kind, whole = kind or code, whole + data
            if first & 0x80:
                return kind, whole

    def close(self):
        self.socket.close()


class Page(Socket):
    """A connection, as the page has one."""

    def __init__(self, server, token=None, origin=None, receive_buffer=None):
        super().__init__(server.port, f"/socket?token={token or server.token}", origin, receive_buffer)
        self.wishes, self.acknowledges = 0, True

    def wish(self, **keys):
        self.wishes += 1
        self.send({"wish": self.wishes, **keys})
        return self.wishes

    def receive(self):
        """A Frame, a dictionary, or the bytes of a file. Frames are acknowledged."""
        code, data = self.receive_raw()
        if code == 1:
            return json.loads(data)
        if data[:4] != b"SKLF":
            return data
        if self.acknowledges:
            self.send({"ack": struct.unpack_from("<I", data, 4)[0]})
        return Frame(data)

    def find(self, what, seconds=LIMIT):
        """The next message for which what(message) is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.receive()
            if what(message):
                return message
        raise TimeoutError

    def frame(self, wish=0):
        """The first frame of this wish or of a later one."""
        return self.find(lambda m: isinstance(m, Frame) and m.wish >= wish)

    def text(self, key):
        """The next message with this key."""
        return self.find(lambda m: isinstance(m, dict) and key in m)
