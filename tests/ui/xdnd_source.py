"""Drops a file onto a window as a file manager would: the source's side of the XDND protocol, version 5.

    xdnd_source.py WINDOW-ID X Y FILE        (X, Y on the root window)

Exit code 0 once the target said that it took the drop.
"""
import pathlib
import sys
import time

from Xlib import X, display
from Xlib.protocol import event

VERSION = 5


class Source:
    def __init__(self, target_id):
        self.display = display.Display()
        self.root = self.display.screen().root
        self.target = self.display.create_resource_object("window", target_id)
        self.window = self.root.create_window(0, 0, 1, 1, 0, self.display.screen().root_depth)
        self.selection = self.atom("XdndSelection")
        self.uri_list = self.atom("text/uri-list")

    def atom(self, name):
        return self.display.intern_atom(name)

    def send(self, kind, *values):
        data = [self.window.id, *values] + [0] * (4 - len(values))
        message = event.ClientMessage(window=self.target, client_type=self.atom(kind), data=(32, data))
        self.target.send_event(message, event_mask=X.NoEventMask)
        self.display.flush()

    def wait_for(self, kind, payload, seconds=10):
        """Serves requests for the dropped data until the target sends `kind`."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if not self.display.pending_events():
                time.sleep(0.01)
                continue
            got = self.display.next_event()
            if got.type == X.SelectionRequest:
                got.requestor.change_property(got.property, got.target, 8, payload)
                answer = event.SelectionNotify(time=got.time, requestor=got.requestor, selection=got.selection,
                                               target=got.target, property=got.property)
                got.requestor.send_event(answer)
                self.display.flush()
            elif got.type == X.ClientMessage and got.client_type == self.atom(kind):
                return got.data[1]
        raise SystemExit(f"the window did not answer with {kind}")

    def drop(self, x, y, path):
        aware = self.target.get_full_property(self.atom("XdndAware"), X.AnyPropertyType)
        if aware is None:
            raise SystemExit("the window takes no drops (no XdndAware)")
        payload = (pathlib.Path(path).resolve().as_uri() + "\r\n").encode()
        self.window.set_selection_owner(self.selection, X.CurrentTime)
        self.send("XdndEnter", VERSION << 24, self.uri_list, 0, 0)
        self.send("XdndPosition", 0, (x << 16) | y, X.CurrentTime, self.atom("XdndActionCopy"))
        if not self.wait_for("XdndStatus", payload)[1] & 1:
            raise SystemExit("the window refuses the drop")
        self.send("XdndDrop", 0, X.CurrentTime, 0, 0)
        self.wait_for("XdndFinished", payload)


if __name__ == "__main__":
    window, x, y, path = sys.argv[1:]
    Source(int(window, 0)).drop(int(x), int(y), path)
