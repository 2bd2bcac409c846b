"""A terminal to run a program in, and to look at."""
import itertools
import os
import re
import subprocess
import time


# A shell with job control, as people have one.
SHELL = "PS1='$ ' HISTFILE= bash --norc --noprofile -i"


class Terminal:
    """A window of tmux, in a server of its own: the name of one that is ending is not to be had at once."""
    numbers = itertools.count()

    def __init__(self, command, columns=100, rows=30, locale="C.UTF-8"):
        self.name = f"strainfinger_{os.getpid()}_{next(self.numbers)}"
        environment = dict(os.environ, LC_ALL=locale, TERM="xterm-256color")
        environment.pop("NO_COLOR", None)
        self.tmux("-f", "/dev/null", "new-session", "-d", "-x", str(columns), "-y", str(rows), command + "; echo ended: $?; sleep 60",
                  env=environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.tmux("kill-server", check=False)

    def tmux(self, *arguments, check=True, **options):
        return subprocess.run(["tmux", "-u", "-L", self.name, *arguments], check=check, capture_output=True, text=True, **options).stdout

    def screen(self, escapes=False):
        return self.tmux("capture-pane", "-p", *(["-e"] if escapes else []))

    def is_given_back(self):
        """The screen is the shell's, and has a cursor."""
        return self.tmux("display-message", "-p", "#{alternate_on} #{cursor_flag}").split() == ["0", "1"]

    def resize(self, columns, rows):
        self.tmux("resize-window", "-x", str(columns), "-y", str(rows))

    def press(self, *keys):
        self.tmux("send-keys", *keys)

    def wait_for(self, pattern, longest_s=20):
        """The screen when it holds the regular expression."""
        end = time.monotonic() + longest_s
        while time.monotonic() < end:
            screen = self.screen()
            if re.search(pattern, screen):
                return screen
            time.sleep(0.05)
        raise AssertionError(f"not within {longest_s} s: {pattern}; the screen:\n{screen}")
