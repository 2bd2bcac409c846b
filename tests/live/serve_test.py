#!/usr/bin/env python3
"""serve_test.py PROGRAM: the live page's server, by sockets: what it says, to how many, and what it withstands."""
import contextlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

from fingers import UNTOUCHED, Bench, Reader, cpu_s, touched

PROGRAM = sys.argv.pop(1)
FIRST_PORT_FOR_ALL = pathlib.Path("/proc/sys/net/ipv4/ip_unprivileged_port_start")


def raw(url, data, timeout_s=10):
    """Sends bytes and returns all that comes back."""
    address = urllib.parse.urlsplit(url)
    with socket.create_connection((address.hostname, address.port), timeout=timeout_s) as connection:
        received = b""
        try:
            connection.sendall(data)
            while chunk := connection.recv(65536):
                received += chunk
        except ConnectionError:
            pass
        return received


def status_of(answer):
    return int(answer.split()[1]) if answer.startswith(b"HTTP/1.1 ") else None


def post(url, headers):
    request = urllib.request.Request(url, method="POST", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, json.load(answer)["text"]
    except urllib.error.HTTPError as error:
        return error.code, json.load(error)["text"]


class Serve(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(PROGRAM)
        cls.addClassCleanup(cls.bench.close)
        for node in (1, 2, 3):
            cls.bench.finger(node)
        cls.process, cls.url = cls.bench.serve()
        cls.bench.wait_for(cls.url, lambda state: len(state["fingers"]) == 3 and touched(state))

    def assertServes(self):
        self.assertIsNone(self.process.poll())
        self.assertEqual(3, len(self.bench.state(self.url)["fingers"]))

    def test_the_page_needs_nothing_from_a_network(self):
        page = urllib.request.urlopen(self.url, timeout=5).read().decode()
        self.assertTrue(page.startswith("<!doctype html>"))
        outside = page.replace("http://www.w3.org/2000/svg", "")  # a name, not an address
        self.assertNotIn("http:", outside)
        self.assertNotIn("https:", outside)
        self.assertNotIn("src=", outside)

    def test_a_state_has_what_the_fingers_say(self):
        finger = self.bench.state(self.url)["fingers"][0]
        self.assertEqual((1, "run", False), (finger["node"], finger["state"], finger["silent"]))
        self.assertTrue(0 <= finger["touch"]["angle_deg"] < 360)
        self.assertIn("simulated", finger["touch"]["flags"])
        self.assertGreater(finger["touch"]["sigma_normal_n"], 0)

    def test_twenty_readers_with_dead_and_slow_ones_among_them_all_get_every_touch_in_time(self):
        address = urllib.parse.urlsplit(self.url)
        dead = [socket.create_connection((address.hostname, address.port)) for _ in range(10)]
        for connection in dead[:5]:  # ask and never read
            connection.sendall(b"GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n")
        for connection in dead[5:]:  # never finish asking
            connection.sendall(b"GET /events HTTP/1.1\r\nHost: loc")
        readers = [Reader(self.url, 6) for _ in range(20)]
        for reader in readers:
            reader.start()
        for reader in readers:
            reader.join()
        for connection in dead:
            connection.close()
        for reader in readers:
            self.assertGreater(len(reader.states), 60)  # 150 on an idle machine
            times = [state["time_s"] for state in reader.states]
            self.assertEqual(sorted(set(times)), times)
        print("latest event of 20 readers:", max(reader.latest_s for reader in readers), "s", file=sys.stderr)
        self.assertServes()

    def test_a_reader_beyond_the_sixty_fourth_is_told_to_come_again(self):
        address = urllib.parse.urlsplit(self.url)
        request = b"GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"
        readers = []
        for _ in range(64):
            readers.append(socket.create_connection((address.hostname, address.port), timeout=5))
            readers[-1].sendall(request)
            self.assertTrue(readers[-1].recv(100).startswith(b"HTTP/1.1 200"))
        answer = raw(self.url, request)
        self.assertEqual(503, status_of(answer))
        self.assertIn(b"Retry-After", answer)
        self.assertServes()
        for reader in readers:
            reader.close()

        def reads():
            with socket.create_connection((address.hostname, address.port), timeout=5) as again:
                again.sendall(request)
                return again.recv(100).startswith(b"HTTP/1.1 200")

        end = time.monotonic() + 10
        while not reads():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)

    def test_what_is_no_request_is_refused_and_harms_nobody(self):
        for data in (b"\r\n\r\n", b"\0" * 1000, os.urandom(5000) + b"\r\n\r\n", b"GET\r\n\r\n", b"BREW / HTTP/1.1\r\n\r\n",
                     b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n", b"GET /%zz%00 HTTP/1.1\r\nHost: localhost\r\n\r\n",
                     b"POST /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nContent-Length: -5\r\n\r\n",
                     b"POST /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"):
            status = status_of(raw(self.url, data))
            self.assertTrue(status is None or 400 <= status < 600, (data[:40], status))
            self.assertServes()

    def test_what_is_too_large_is_refused_and_harms_nobody(self):
        host = b"Host: localhost\r\n"
        for data in (b"GET /" + b"a" * 100000 + b" HTTP/1.1\r\n" + host + b"\r\n",
                     b"GET /fingers/" + b"1" * 8000 + b"/tare HTTP/1.1\r\n" + host + b"\r\n",
                     b"GET / HTTP/1.1\r\n" + host + b"X: " + b"a" * 100000 + b"\r\n\r\n",
                     b"POST /fingers/1/tare HTTP/1.1\r\n" + host + b"X-Strainfinger: -\r\nContent-Length: 9999999\r\n\r\n" + b"a" * 9999999):
            status = status_of(raw(self.url, data))
            self.assertTrue(status is None or 400 <= status < 600, (data[:40], status))
            self.assertServes()

    def test_many_headers_harm_nobody(self):
        raw(self.url, b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X: a\r\n" * 100000 + b"\r\n")
        self.assertServes()

    def test_what_is_wrong_with_a_request_is_said(self):
        get, post = b"GET / HTTP/1.1\r\nHost: localhost\r\n", b"POST /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nX-Strainfinger: -\r\n"
        for status, why, data in ((400, b"is larger than 16 KiB", get + b"X: a\r\n" * 4000 + b"\r\n"),
                                  (400, b"was not whole after 2 s", get),
                                  (413, b"body is larger than 1024 bytes", post + b"Content-Length: 2000\r\n\r\n" + b"a" * 2000),
                                  (414, b"address is too long", b"GET /" + b"a" * 9000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n"),
                                  (416, b"Range was not understood", get + b"Range: bytes=5-1\r\n\r\n")):
            answer = raw(self.url, data)
            self.assertEqual(status, status_of(answer), data[:200])
            self.assertIn(why, answer)

    def test_of_a_page_in_many_ranges_it_is_sent_once(self):
        plain = raw(self.url, b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        ranges = raw(self.url, b"GET / HTTP/1.1\r\nHost: localhost\r\nRange: bytes=" + b"0-," * 2000 + b"0-\r\n\r\n")
        self.assertEqual((200, len(plain)), (status_of(ranges), len(ranges)))

    def test_clients_that_never_end_their_request_keep_nobody_out(self):
        address = urllib.parse.urlsplit(self.url)
        slow = [socket.create_connection((address.hostname, address.port)) for _ in range(120)]
        for connection in slow:
            connection.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n")
        asked, began = socket.create_connection((address.hostname, address.port), timeout=0.5), time.monotonic()
        asked.sendall(b"GET /state HTTP/1.1\r\nHost: localhost\r\n\r\n")
        answer = b""
        while not answer:
            self.assertLess(time.monotonic() - began, 15)  # 2 s for 96 threads, 4 s for all
            for connection in slow:
                with contextlib.suppress(ConnectionError):
                    connection.sendall(b"X: a\r\n")
            with contextlib.suppress(TimeoutError):
                answer = asked.recv(100)
        self.assertEqual(200, status_of(answer))
        for connection in slow + [asked]:
            connection.close()

    def test_a_burst_of_clients_waits_in_the_system(self):
        address = urllib.parse.urlsplit(self.url)
        self.process.send_signal(signal.SIGSTOP)
        try:
            for connection in [socket.create_connection((address.hostname, address.port), timeout=0.9) for _ in range(100)]:
                connection.close()
        finally:
            self.process.send_signal(signal.SIGCONT)

    def test_ranges_of_events_are_harmless(self):
        address = urllib.parse.urlsplit(self.url)
        with socket.create_connection((address.hostname, address.port), timeout=5) as connection:
            connection.sendall(b"GET /events HTTP/1.1\r\nHost: localhost\r\nRange: bytes=0-10,5-1,-\r\n\r\n")
            connection.recv(100)
        self.assertServes()

    def test_a_tare_that_is_refused_says_why(self):
        status, text = post(self.url + "fingers/1/tare", {"X-Strainfinger": "-"})
        self.assertEqual(409, status)
        self.assertIn("something touches the finger", text)

    def test_a_command_may_come_without_a_body_and_its_length(self):
        answer = raw(self.url, b"POST /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nX-Strainfinger: -\r\n\r\n")  # curl -X POST
        self.assertEqual(409, status_of(answer))
        self.assertIn(b"something touches the finger", answer)

    def test_a_tare_of_a_node_that_is_not_there_has_no_answer(self):
        status, text = post(self.url + "fingers/9/tare", {"X-Strainfinger": "-"})
        self.assertEqual((409, "node 9: tare: no answer: is it on the bus still?"), (status, text))

    def test_a_tare_of_what_is_no_node_is_refused(self):
        for node in ("0", "64", "99"):
            self.assertEqual(404, post(self.url + f"fingers/{node}/tare", {"X-Strainfinger": "-"})[0])

    def test_what_is_not_there_is_told_with_what_is(self):
        for path in ("nothing", "state", "fingers/abc/tare"):
            status, text = post(self.url + path, {"X-Strainfinger": "-"})
            self.assertEqual(status, 404)
            self.assertIn(f"POST /{path} is not known: GET /, /finger, /state, /events; POST /fingers/NODE/tare", text)

    def test_what_is_no_text_does_not_end_it(self):
        answer = raw(self.url, b"GET /%ff HTTP/1.1\r\nHost: localhost\r\n\r\n")
        self.assertEqual(404, status_of(answer))
        self.assertIn(b" is not known", answer)
        self.assertIn(b"was not understood", raw(self.url, b"GARBAGE\r\n\r\n"))
        self.assertEqual(200, urllib.request.urlopen(self.url + "state", timeout=10).status)

    def test_another_page_cannot_command(self):
        self.assertEqual(403, post(self.url + "fingers/1/tare", {})[0])
        answer = raw(self.url, b"OPTIONS /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.example\r\n"
                     b"Access-Control-Request-Method: POST\r\nAccess-Control-Request-Headers: x-strainfinger\r\n\r\n")
        self.assertNotIn(b"Access-Control-Allow", answer)

    def test_a_name_that_was_made_to_mean_this_machine_reads_nothing(self):
        for host in (b"evil.example", b"127.evil.example:80", b"localhost.evil.example", b""):
            answer = raw(self.url, b"GET /state HTTP/1.1\r\nHost: " + host + b"\r\n\r\n")
            self.assertEqual(403, status_of(answer), host)
            self.assertNotIn(b"fingers", answer)

    def test_a_port_that_is_taken_is_said_to_be(self):
        port = str(urllib.parse.urlsplit(self.url).port)
        run = subprocess.run([PROGRAM, "serve", "--can", self.bench.bus, "--port", port], capture_output=True, text=True)
        self.assertEqual(1, run.returncode)
        self.assertIn(f"cannot listen on 127.0.0.1 port {port}: another program does", run.stderr)

    def test_an_address_that_cannot_be_listened_on_is_said_why(self):
        for address, why in (("192.0.2.1", "this machine has no such address"), ("no.such.invalid", "this is no address: ")):
            run = subprocess.run([PROGRAM, "serve", "--can", self.bench.bus, "--port", "0", "--address", address], capture_output=True, text=True)
            self.assertEqual(1, run.returncode)
            self.assertIn(f"cannot listen on {address} port 0: {why}", run.stderr)

    @unittest.skipIf(int(FIRST_PORT_FOR_ALL.read_text()) <= 80, "here everybody may listen on all ports")
    def test_a_port_for_root_is_said_to_be(self):
        without_right = ["setpriv", "--bounding-set", "-net_bind_service"] if os.geteuid() == 0 else []
        run = subprocess.run([*without_right, PROGRAM, "serve", "--can", self.bench.bus, "--port", "80"], capture_output=True, text=True)
        self.assertEqual(1, run.returncode)
        self.assertIn("cannot listen on 127.0.0.1 port 80: ports below 1024 are for root", run.stderr)


class Cost(unittest.TestCase):
    def test_three_fingers_cost_less_than_a_tenth_of_a_core_and_no_frame(self):
        with Bench(PROGRAM) as bench:
            process, url = bench.serve()
            bench.chatter()
            bench.wait_for(url, lambda state: len(state["fingers"]) == 3)
            reader = Reader(url, 5)
            before_s, began_s = cpu_s(process), time.monotonic()
            reader.start()
            reader.join()
            share = (cpu_s(process) - before_s) / (time.monotonic() - began_s)
            fingers = reader.states[-1]["fingers"]
            contacts = [finger["contacts_per_s"] for finger in fingers]
            print(f"serve: {100 * share:.1f} % of a core at {contacts} contacts a second", file=sys.stderr)
            self.assertLess(share, 0.1)
            self.assertGreater(min(contacts), 400)  # 500 where the talk itself is not held up
            self.assertEqual([0, 0, 0, 0], [reader.states[-1]["missed"]] + [finger["lost"] for finger in fingers])


class Untouched(unittest.TestCase):
    def test_a_tare_is_done(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1, UNTOUCHED)
            _, url = bench.serve()
            bench.wait_for(url, lambda state: state["fingers"] and state["fingers"][0]["state"] == "run")
            self.assertEqual((200, "node 1: tare: Done"), post(url + "fingers/1/tare", {"X-Strainfinger": "-"}))

    def test_a_finger_that_ends_is_silent(self):
        with Bench(PROGRAM) as bench:
            finger = bench.finger(1)
            _, url = bench.serve()
            bench.wait_for(url, touched)
            Bench._end(finger)
            state = bench.wait_for(url, lambda state: state["fingers"][0]["silent"])
            self.assertIsNone(state["fingers"][0]["touch"])


class Open(unittest.TestCase):
    """Beyond this machine."""

    def test_commands_need_the_token_that_was_printed(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1, UNTOUCHED)
            _, url = bench.serve("--address", "0.0.0.0")
            url, _, token = url.replace("0.0.0.0", "127.0.0.1").partition("#")
            self.assertRegex(token, "^[0-9a-f]{32}$")
            bench.wait_for(url, lambda state: state["fingers"] and state["fingers"][0]["state"] == "run")
            for wrong in ("-", "", token[:-1], token + "0", token.upper() if token != token.upper() else "x"):
                self.assertEqual(403, post(url + "fingers/1/tare", {"X-Strainfinger": wrong})[0])
            self.assertEqual(200, post(url + "fingers/1/tare", {"X-Strainfinger": token})[0])

    def test_a_token_can_be_given(self):
        with Bench(PROGRAM) as bench:
            _, url = bench.serve("--token", "kept secret")
            self.assertTrue(url.endswith("/#kept%20secret"))
            self.assertEqual(403, post(url.partition("#")[0] + "fingers/1/tare", {"X-Strainfinger": "-"})[0])

    def test_a_token_of_the_environment_is_not_in_the_list_of_processes(self):
        with Bench(PROGRAM) as bench:
            process, url = bench.serve(env=dict(os.environ, STRAINFINGER_TOKEN="kept secret/&"))
            url, _, token = url.partition("#")
            self.assertEqual("kept%20secret%2F%26", token)
            self.assertEqual("kept secret/&", urllib.parse.unquote(token))  # as the page does
            self.assertNotIn("secret", pathlib.Path(f"/proc/{process.pid}/cmdline").read_text())
            self.assertEqual(403, post(url + "fingers/1/tare", {"X-Strainfinger": "kept"})[0])
            self.assertEqual(409, post(url + "fingers/1/tare", {"X-Strainfinger": "kept secret/&"})[0])  # no such finger

    def test_the_option_counts_before_the_environment(self):
        with Bench(PROGRAM) as bench:
            _, url = bench.serve("--token", "said here", env=dict(os.environ, STRAINFINGER_TOKEN="kept there"))
            self.assertTrue(url.endswith("/#said%20here"))


class Usage(unittest.TestCase):
    def check(self, status, named, *arguments, **environment):
        run = subprocess.run([PROGRAM, "serve", *arguments], capture_output=True, text=True, timeout=20, env=dict(os.environ, **environment))
        self.assertEqual((status, ""), (run.returncode, run.stdout))
        self.assertIn(named, run.stderr)

    def test_it_needs_a_bus(self):
        self.check(2, "--can")

    def test_a_port_is_a_number_up_to_65535(self):
        self.check(2, "--port", "--can", "udp", "--port", "65536")

    def test_an_empty_token_where_others_reach_it_is_refused(self):
        named = "the token (--token, STRAINFINGER_TOKEN) is empty, and others reach 0.0.0.0"
        self.check(2, named, "--can", "udp", "--address", "0.0.0.0", "--token", "")
        self.check(2, named, "--can", "udp", "--address", "0.0.0.0", STRAINFINGER_TOKEN="")

    def test_a_token_that_no_header_can_hold_is_refused(self):
        for token in ("two\nlines of it", "gr\u00fcn wie Gras", "percent%41", " in front", "far behind "):
            self.check(2, "must be printable ASCII", "--can", "udp", "--token", token)

    def test_a_token_that_can_be_guessed_is_refused(self):
        self.check(2, "has 7 characters and can be guessed: it must have 8 at least", "--can", "udp", "--token", "1234567")

    def test_what_no_machine_has_for_an_address_is_refused(self):
        self.check(2, "--address is empty", "--can", "udp", "--address", "")
        self.check(2, "brackets are for a browser, leave them out", "--can", "udp", "--address", "[::1]")

    def test_a_missing_interface_is_said_with_its_remedy(self):
        self.check(3, "nocan7", "--can", "nocan7")


if __name__ == "__main__":
    unittest.main()
