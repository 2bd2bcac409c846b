#!/usr/bin/env python3
"""page_test.py PROGRAM [PICTURE]: the live page in headless Chromium. With PICTURE, a screenshot of it is left there."""
import contextlib
import json
import signal
import socket
import subprocess
import sys
import unittest
import urllib.parse

from fingers import UNTOUCHED, Bench, bench_with_two
import browser

if browser.CHROMIUM is None:
    print("chromium is not installed: apt install chromium")
    sys.exit(77)

PROGRAM = sys.argv.pop(1)
PICTURE = sys.argv.pop(1) if len(sys.argv) > 1 and sys.argv[1].endswith(".png") else None

# Touched for half a second of each second: presses, to be timed.
PRESSES = """schema = 1
repeat_s = 1
[[touch]]
start_s = 0.4
end_s = 0.9
angle_deg = 130
normal_n_per_m = [[0, 20], [0.5, 20]]
"""

# Touched in one place with one force: a state and a set of strains agree although some milliseconds lie between them.
HELD = """schema = 1
[[touch]]
start_s = 0.3
end_s = 600
angle_deg = 130
normal_n_per_m = 20
"""
HELD_N = 0.4  # on 20 mm

# Times from the moment the program had the frames of a press to the one they are in the page.
WATCH_PRESSES = """
window.lateness_ms = [];
new MutationObserver(() => {
  const touch = newest.fingers[0].touch;
  const shown = document.querySelector('#finger-1 .normal').textContent !== '–';
  if (shown && !window.wasShown && touch) window.lateness_ms.push(Date.now() - 1000 * touch.since_s);
  window.wasShown = shown;
}).observe(document.querySelector('#finger-1 .normal'), {childList: true, characterData: true, subtree: true});
"""


class LivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = bench_with_two(cls, PROGRAM)
        _, cls.url = cls.bench.serve()
        cls.page = browser.Page(cls.url)
        cls.page.__enter__()
        cls.addClassCleanup(cls.page.__exit__)
        cls.page.wait_for("document.querySelectorAll('article').length === 2")
        cls.page.wait_for("document.querySelector('#finger-1 .normal').textContent.includes('N')")

    def test_a_card_shows_its_finger(self):
        self.assertEqual("Finger 1", self.page.text("#finger-1 h2"))
        self.assertEqual("run", self.page.text("#finger-1 .state"))
        self.assertRegex(self.page.text("#finger-1 .angle"), r"^\d+\.\d\d ± \d+\.\d\d °$")
        self.assertRegex(self.page.text("#finger-1 .normal"), r"^\d\.\d{3} ± ≥?\d\.\d{3} N$")
        self.assertRegex(self.page.text("#finger-1 .tangential"), r"^[+-]?\d\.\d{3} ± ≥?\d\.\d{3} N$")
        self.assertRegex(self.page.text("#finger-1 .stats"), r"\d+ contacts/s · jitter .* 0 lost")
        self.assertIn("simulated", self.page.text("#finger-1 .chips"))
        self.assertRegex(self.page.text("#bus"), r"^udp:\d+ · \d+ frames/s · load \d")
        self.assertEqual("live", self.page.text("#link"))

    def test_the_largest_that_a_finger_can_say_is_that_or_more(self):
        touch = '{normal_n: 0.5, sigma_normal_n: 0.127, or_more: ["sigma_normal_n"]}'
        self.assertEqual("0.500 <small>± ≥0.127 N</small>", self.page.value(f'valueHtml({touch}, "normal_n", 3, "N")'))

    def test_a_second_contact_has_all_its_numbers(self):
        second = ('{angle_deg: 215, sigma_angle_deg: 0.25, normal_n: 0.36, sigma_normal_n: 0.01, tangential_n: 0.02, sigma_tangential_n: 0.03,'
                  ' or_more: []}')
        self.assertEqual("Second: 215.0 ± 0.3 °, 0.360 ± 0.010 N, +0.020 ± 0.030 N",
                         self.page.value(f"(() => {{ const p = document.createElement('p'); p.innerHTML = secondHtml({second}); return p.textContent; }})()"))

    def test_another_angle_that_fits_as_well_is_told(self):
        self.assertEqual("20 <small>%</small> <small>or at 10°</small>",
                         self.page.value("qualityHtml({quality_percent: 20, angle_deg: 350.2, alternative_deg: 20})"))

    def test_troubles_and_faults_are_told(self):
        finger = '{troubles: ["silent for 2.0 s", "fault noisy: hum", "gauges out of use: 3"]}'
        self.assertEqual("silent for 2.0 s · fault noisy: hum · gauges out of use: 3", self.page.value(f"warningsOf({finger})"))

    def test_what_is_not_known_is_not_said_to_be_untouched(self):
        for expected, finger in (("silent, not known whether it is touched", "{silent: true, touch: null, state: 'run'}"),
                                 ("another protocol, not known whether it is touched", "{foreign: true, touch: null, state: null}"),
                                 ("fault, not known whether it is touched", "{touch: {touched: false}, state: 'fault'}"),
                                 ("no touch known", "{touch: null, state: 'run'}"),
                                 ("not touched", "{touch: {touched: false}, state: 'run'}"),
                                 ("touched at 12 degrees, normal force 0.34 newton",
                                  "{touch: {touched: true, angle_deg: 12.3, normal_n: .341}, state: 'run'}")):
            self.assertEqual(expected, self.page.value(f"summaryOf({finger})"))

    def test_warnings_are_news_once(self):
        fingers = [dict(finger, state="run", silent=silent, touch={"touched": False}, gauges=None) for finger, silent in (
            ({"troubles": []}, False), ({"troubles": ["fault noisy: hum"]}, False), ({"troubles": ["fault noisy: hum"]}, False),
            ({"troubles": ["silent for 0.5 s", "fault noisy: hum"]}, True), ({"troubles": ["silent for 0.6 s", "fault noisy: hum"]}, True),
            ({"troubles": []}, False))]
        told = self.page.value(f"""(() => {{ const card = {{...cards.get(2), section: svg("g", {{}}), toldOf: kNothingTold}}, kept = news;
          return {json.dumps(fingers)}.map(finger => {{ news = []; say(card, finger); const told = news.join("; "); news = kept; return told; }}); }})()""")
        self.assertRegex(told[1], "^Finger 2: fault noisy: ")
        self.assertEqual(["", "", "Finger 2: silent, not known whether it is touched", "", "Finger 2: not touched; Finger 2: no warnings any more"],
                         told[:1] + told[2:])

    def test_points_of_a_clock_that_was_set_back_are_dropped(self):
        later, drawn = self.page.value("""(() => { const finger = newest.fingers[0], card = cards.get(1), kept = card.points.slice();
          show(finger, newest.time_s - 3600);
          const later = card.points.filter(point => point.t > newest.time_s - 3600).length, drawn = card.points.length;
          card.points = kept;
          return [later, drawn]; })()""")
        self.assertEqual((0, 1), (later, drawn))

    def test_lines_are_told_apart_without_colours(self):
        legend = self.page.value("[...document.querySelectorAll('#finger-1 [data-line] path')].map(path => path.getAttribute('stroke-dasharray'))")
        self.assertEqual((4, 4), (len(legend), len(set(legend))))
        drawn = self.page.value("""(() => { const canvas = document.createElement("canvas"), pen = canvas.getContext("2d"), dashes = [];
          let dash;
          pen.setLineDash = given => { dash = given.join(" ") || "none"; };
          pen.stroke = () => dashes.push(dash);
          const force = {value: .2, sigma: 0, least: .2, most: .2};
          drawForces(canvas, [{t: 1, normal: force, tangential: force, normal2: .1, tangential2: .1}], 1);
          return dashes; })()""")
        self.assertTrue(set(legend) <= set(drawn), (legend, drawn))

    def told_of_a_tare(self, error):
        return self.page.value(f"""(async () => {{ const real = fetch; window.fetch = async () => {{ throw {error}; }};
          await tare(cards.get(2), 2);
          window.fetch = real;
          return cards.get(2).find(".told").textContent; }})()""")

    def test_of_a_tare_without_answer_no_more_is_said_than_is_known(self):
        self.assertEqual("No answer in 10 s: the zero may have been taken or not.", self.told_of_a_tare("new DOMException('', 'TimeoutError')"))
        self.assertEqual("No answer: the program cannot be reached.", self.told_of_a_tare("new TypeError('Failed to fetch')"))

    def test_an_outcome_is_forgotten_after_half_a_minute(self):
        self.assertEqual([30000, "done", ""], self.page.value("""(() => { const real = setTimeout, card = cards.get(2), told = card.find(".told");
          let later, after_ms;
          window.setTimeout = (what, ms) => { later = what; after_ms = ms; };
          showOutcome(card, "done");
          window.setTimeout = real;
          const shown = told.textContent;
          later();
          return [after_ms, shown, told.textContent]; })()"""))

    def test_flags_of_doubt_stand_out(self):
        doubts = self.page.value("""(() => { const list = document.createElement('ul'); showChips(list, ['contact', 'uncertain', 'simulated', 'stale_zero']);
          return [...list.children].map(chip => [chip.textContent, chip.classList.contains('doubt')]); })()""")
        self.assertEqual([["uncertain", True], ["simulated", False], ["stale zero", True]], doubts)

    def test_numbers_change(self):
        before = self.page.text("#finger-1 .angle")
        self.page.wait_for(f"document.querySelector('#finger-1 .angle').textContent !== '{before}'")

    def test_an_untouched_finger_shows_none(self):
        self.assertEqual("–", self.page.text("#finger-2 .angle"))
        self.assertEqual("Finger 2: no touch known", self.page.value("document.querySelector('#finger-2 svg').getAttribute('aria-label')"))

    def test_the_cross_section_has_arrow_wedge_and_width(self):
        parts = self.page.wait_for("(() => { const live = document.querySelector('#finger-1 svg g'); return live.childElementCount >= 3 && live.innerHTML; })()")
        self.assertIn("Z", parts)           # the wedge and the arrow's head
        self.assertIn("stroke-width=\"6\"", parts)  # the width
        self.assertEqual(16, self.page.value("cards.get(1).gauges.length"))

    def test_the_arrow_is_where_the_finger_is_touched(self):
        # Both from one state: the wedge's middle against the number.
        off_deg = self.page.value("""(() => {
          const d = document.querySelector('#finger-1 svg g path').getAttribute('d').match(/L(\\S+) (\\S+) A\\S+ \\S+ 0 . 0 (\\S+) (\\S+)/).slice(1).map(Number);
          const deg = Math.atan2(-(d[1] + d[3]), d[0] + d[2]) * 180 / Math.PI;
          const off = deg - parseFloat(document.querySelector('#finger-1 .angle').textContent);
          return (off % 360 + 540) % 360 - 180;
        })()""")
        self.assertLess(abs(off_deg), 0.1)

    def test_charts_are_drawn(self):
        self.page.wait_for("cards.get(1).points.length > 20")
        for canvas in (".forces", ".angles"):
            inked = self.page.value(f"""(() => {{ const c = document.querySelector('#finger-1 {canvas}');
              return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.filter(v => v).length; }})()""")
            self.assertGreater(inked, 1000)

    def test_tare_works_by_keyboard_alone(self):
        self.page.value("document.querySelector('#finger-1 button').focus()")
        self.page.press("Tab", 9)
        self.assertEqual("Tare finger 2: zero its gauges", self.page.value("document.activeElement.getAttribute('aria-label')"))
        self.page.press("Enter", 13, "\r")
        self.page.wait_for("document.querySelector('#finger-2 .told').textContent === 'node 2: tare: Done'")

    def test_a_tare_of_a_touched_finger_says_why_not(self):
        self.page.value("document.querySelector('#finger-1 button').click()")
        self.page.wait_for("document.querySelector('#finger-1 .told').textContent.includes('something touches the finger')")

    def test_a_screen_reader_finds_names_for_everything(self):
        nodes = self.page.do("Accessibility.getFullAXTree")["nodes"]
        named = {(node["role"]["value"], node.get("name", {}).get("value", "")) for node in nodes if not node.get("ignored")}
        roles = {}
        for role, name in named:
            roles.setdefault(role, set()).add(name)
        self.assertIn("Tare finger 1: zero its gauges", roles["button"])
        self.assertIn("Finger 1", roles["article"])
        self.assertIn("Fingers", roles["main"])
        images = roles.get("img", set()) | roles.get("image", set())
        self.assertIn("Normal and tangential force over the last 30 seconds", images)
        self.assertTrue(any(name.startswith("Finger 1: touched at") for name in images), images)
        for role in ("button", "img", "image", "article", "heading"):
            self.assertNotIn("", roles.get(role, set()), role)

    def test_it_fits_a_phone(self):
        self.page.resize(360, 780, phone=True)
        self.page.wait_for("innerWidth === 360 || document.documentElement.clientWidth === 360")
        self.assertLessEqual(self.page.value("document.documentElement.scrollWidth"), 360)
        self.assertLess(self.page.value("document.querySelector('article').getBoundingClientRect().right"), 360)
        self.page.resize(320, 780, phone=True)
        self.page.wait_for("document.documentElement.clientWidth === 320")
        self.assertEqual([], self.page.value("""[...document.querySelectorAll('dd')].filter(value =>
          value.scrollWidth > value.clientWidth).map(value => value.textContent)"""))
        self.page.resize(1100, 900)

    def test_it_fits_a_phone_whose_text_is_doubled(self):
        self.page.resize(320, 780, phone=True)
        self.page.wait_for("document.documentElement.clientWidth === 320")
        self.page.value("document.documentElement.style.fontSize = '200%', document.body.style.fontSize = '30px'")
        beyond = self.page.value("""[...document.querySelectorAll('body *')].filter(part => part.getBoundingClientRect().right > 321)
          .map(part => part.tagName + " " + part.textContent.slice(0, 20))""")
        width = self.page.value("document.documentElement.scrollWidth")
        self.page.value("document.documentElement.style.fontSize = document.body.style.fontSize = ''")
        self.page.resize(1100, 900)
        self.assertEqual(([], 320), (beyond, width))

    def contrast(self, ink, paper):
        return self.page.value("""((a, b) => {
          const light = name => { const c = color(name).slice(1), full = c.length === 3 ? [...c].map(x => x + x).join('') : c;
            const [r, g, b] = [0, 2, 4].map(i => parseInt(full.slice(i, i + 2), 16) / 255).map(v => v <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4);
            return .2126 * r + .7152 * g + .0722 * b; };
          const [x, y] = [light(a), light(b)].sort((p, q) => q - p);
          return (x + .05) / (y + .05); })('%s', '%s')""" % (ink, paper))

    def test_light_and_dark_are_readable(self):
        backgrounds = set()
        for scheme in ("light", "dark"):
            self.page.scheme(scheme)
            backgrounds.add(self.page.value("getComputedStyle(document.body).backgroundColor"))
            for ink in ("--ink", "--soft", "--normal", "--tangential", "--second", "--warn", "--bad", "--good"):
                self.assertGreater(self.contrast(ink, "--card"), 4.5, (scheme, ink))  # WCAG 2.1, 1.4.3
        self.assertEqual(2, len(backgrounds))
        self.page.scheme("light")

    def test_nothing_went_wrong_in_the_page(self):
        self.page.value("0")
        refusals = [error for error in self.page.errors if "409" not in str(error)]  # the refused tare
        self.assertEqual([], refusals)


class InTime(unittest.TestCase):
    def test_a_press_is_on_the_page_within_a_tenth_of_a_second(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1, PRESSES)
            _, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("document.querySelector('#finger-1 .normal') !== null")
                page.value(WATCH_PRESSES)
                late_ms = page.wait_for("window.lateness_ms.length >= 10 && window.lateness_ms", 60)
        print("a press is on the page after ms:", sorted(round(ms) for ms in late_ms), file=sys.stderr)
        self.assertLess(sorted(late_ms)[len(late_ms) // 2], 100)


class Strains(unittest.TestCase):
    def test_strains_are_drawn_beside_the_fit_while_they_stream(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1, HELD)
            _, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("document.querySelector('#finger-1 .raw')?.hidden")
                page.wait_for(f"newest.fingers[0].touch?.normal_n > {0.9 * HELD_N}")
                strains = bench.start("strains", "--can", bench.bus, "--rate", "50", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                page.wait_for("!document.querySelector('#finger-1 .raw').hidden && newest.fingers[0].fitted !== null")
                strain, fit = page.value("[newest.fingers[0].strains, newest.fingers[0].fitted]")
                self.assertEqual((16, 16), (len(strain), len(fit)))
                deepest = min(strain)
                self.assertLess(deepest, -0.004)  # of a touch, not of noise: 6e-3 below 20 N/m
                for gauge, (read, explained) in enumerate(zip(strain, fit)):
                    self.assertAlmostEqual(read, explained, delta=-deepest / 100, msg=f"gauge {gauge}")
                Bench._end(strains)
                page.wait_for("document.querySelector('#finger-1 .raw').hidden")


@contextlib.contextmanager
def shown_finger():
    """A page that shows a finger, and the program that serves it."""
    with Bench(PROGRAM) as bench:
        bench.finger(1)
        process, url = bench.serve()
        with browser.Page(url) as page:
            page.wait_for("document.querySelector('#finger-1 .state')?.textContent === 'run'")
            yield page, process


class AnotherProtocol(unittest.TestCase):
    def test_a_finger_of_another_protocol_hides_no_other(self):
        with Bench(PROGRAM) as bench:
            log = bench.folder / "protocol_3.log"
            log.write_text("".join(f"({i / 10 + 1:.6f}) can0 701#3200000D0E1900A7\n" for i in range(600)))
            bench.start("replay", str(log), "--can", bench.bus, stderr=subprocess.DEVNULL)
            bench.finger(node=2)
            _, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("/another protocol/.test(document.querySelector('#finger-1')?.textContent)")
                page.wait_for("/speaks protocol 3/.test(document.querySelector('#finger-1 .warnings').textContent)")
                page.wait_for("/^[0-9.]/.test(document.querySelector('#finger-2 .normal')?.textContent)")


class Ending(unittest.TestCase):
    def test_a_page_whose_program_ended_says_so(self):
        with shown_finger() as (page, process):
            Bench._end(process)
            page.wait_for("document.querySelector('#link').textContent.startsWith('connection lost')")
            self.assertEqual(["not connected", "–", "–", ""], [page.text("#finger-1 " + part) for part in (".state", ".angle", ".normal", ".chips")])
            self.assertEqual(["", ""], [page.text("#bus"), page.text("#finger-1 .stats")])
            self.assertEqual(0, page.value("document.querySelector('#finger-1 svg g').childElementCount"))
            self.assertTrue(page.value("document.querySelector('#finger-1 button').disabled"))

    def test_a_page_finds_back_when_its_program_goes_on(self):
        with shown_finger() as (page, process):
            process.send_signal(signal.SIGSTOP)
            page.wait_for("document.querySelector('#finger-1 .state').textContent === 'not connected'")
            process.send_signal(signal.SIGCONT)
            page.wait_for("document.querySelector('#finger-1 .state').textContent === 'run'")
            self.assertEqual("live", page.text("#link"))
            self.assertFalse(page.value("document.body.classList.contains('lost') || document.querySelector('#finger-1 button').disabled"))
            apart_s = page.value("runs(cards.get(1).points, point => point.normal).map(run => Math.max(0, ...run.slice(1).map((point, i) => point.t - run[i].t)))")
            self.assertLess(max(apart_s), 0.35)

    def test_an_outcome_is_not_shown_of_another_connection(self):
        with shown_finger() as (page, process):
            page.value("showOutcome(cards.get(1), 'done')")
            process.send_signal(signal.SIGSTOP)
            page.wait_for("document.querySelector('#finger-1 .state').textContent === 'not connected'")
            process.send_signal(signal.SIGCONT)
            page.wait_for("document.querySelector('#finger-1 .state').textContent === 'run'")
            self.assertEqual("", page.text("#finger-1 .told"))

    def test_silence_is_news_once(self):
        with Bench(PROGRAM) as bench:
            finger = bench.finger(1, UNTOUCHED)
            _, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("document.querySelector('#finger-1 .state')?.textContent === 'run'")
                Bench._end(finger)
                page.wait_for("document.querySelector('#news').textContent === 'Finger 1: silent, not known whether it is touched'")
                self.assertEqual("Finger 1: silent, not known whether it is touched", page.value("document.querySelector('#finger-1 svg').getAttribute('aria-label')"))
                page.value("window.told = 0; new MutationObserver(() => window.told++).observe(document.querySelector('#news'), {childList: true, subtree: true})")
                page.wait_for("/silent for [2-9]/.test(document.querySelector('#finger-1 .warnings').textContent)")
                self.assertEqual(0, page.value("window.told"))

    def test_a_finger_that_went_before_the_page_connected_again_is_not_heard_since(self):
        with Bench(PROGRAM) as bench:
            finger = bench.finger(1)
            process, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("document.querySelector('#finger-1 .state')?.textContent === 'run'")
                Bench._end(finger)
                Bench._end(process)
                page.wait_for("document.querySelector('#finger-1 .state').textContent === 'not connected'")
                bench.start("serve", "--can", bench.bus, "--port", url.rstrip("/").rpartition(":")[2], stderr=subprocess.DEVNULL)
                page.wait_for("document.querySelector('#link').textContent === 'live'")
                page.wait_for("document.querySelector('#finger-1 .state').textContent === 'not heard since the page connected'")
                self.assertTrue(page.value("document.querySelector('#finger-1 button').disabled"))

    def test_a_page_draws_by_the_config_of_the_program_that_it_finds_again(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1)
            process, url = bench.serve()
            with browser.Page(url) as page:
                page.wait_for("cards.get(1)?.gauges.length === 16")
                Bench._end(process)
                page.wait_for("document.querySelector('#link').textContent.startsWith('connection lost')")
                config = bench.folder / "other.toml"
                config.write_text("schema = 1\n[gauges]\ncount = 12\n")
                bench.start("serve", "--can", bench.bus, "-c", str(config), "--port", url.rstrip("/").rpartition(":")[2], stderr=subprocess.DEVNULL)
                page.wait_for("document.querySelector('#link').textContent === 'live' && cards.get(1).gauges.length === 12")

    def test_a_page_that_was_refused_tries_again(self):
        with shown_finger() as (page, _):
            page.value("stream.close()")  # as the browser does after an answer that is no stream
            page.wait_for("document.querySelector('#link').textContent.startsWith('connection lost')")
            page.wait_for("document.querySelector('#link').textContent === 'live'")

    def test_without_its_token_the_page_commands_nothing(self):
        with Bench(PROGRAM) as bench:
            bench.finger(1, UNTOUCHED)
            _, url = bench.serve("--address", "0.0.0.0")
            self.assertEqual(socket.gethostname().lower(), urllib.parse.urlsplit(url).hostname)
            url, _, token = url.replace(socket.gethostname(), "127.0.0.1").partition("#")
            with browser.Page(url) as page:
                page.wait_for("document.querySelector('#finger-1 button')?.disabled")
                self.assertIn("token", page.text("#finger-1 .told"))
                page.value("location.hash = '#of-an-earlier-start'")  # as the address of a bookmark
                page.wait_for("!document.querySelector('#finger-1 button').disabled && !document.querySelector('#finger-1 .told').textContent")
                page.value("document.querySelector('#finger-1 button').click()")
                page.wait_for("/another token. Open the page by the address/.test(document.querySelector('#finger-1 .told').textContent)")
                page.value(f"location.hash = '#{token}'")
                page.value("document.querySelector('#finger-1 button').click()")
                page.wait_for("document.querySelector('#finger-1 .told').textContent === 'node 1: tare: Done'")
            with browser.Page(url + "#100%") as page:  # no token that can be decoded
                page.wait_for("document.querySelector('#link').textContent === 'live'")
            with browser.Page(url + "#" + token) as page:
                page.wait_for("document.querySelector('#finger-1 .state')?.textContent === 'run'")
                page.value("document.querySelector('#finger-1 button').click()")
                page.wait_for("document.querySelector('#finger-1 .told').textContent === 'node 1: tare: Done'")


# What the picture shows: a wide touch that slides and is rubbed; two touches at once, of which one comes and goes.
WIDE_SLIDE = """schema = 1
[[touch]]
start_s = 0.5
end_s = 60
angle_deg = [20, 340, 40]
normal_n_per_m = [10, 14, 30, 18, 36, 22, 30, 12, 24, 34, 20, 26]
tangential_n_per_m = [0, 5, 9, -4, -12, 6, 10, 3, -8, 7, 12, 2]
width_m = [4e-3, 6e-3]
"""
TWO = """schema = 1
repeat_s = 6
[[touch]]
start_s = 0.4
end_s = 5.8
angle_deg = [40, 75, 50]
normal_n_per_m = [0, 24, 30, 22, 0]
tangential_n_per_m = [0, -6, 8, 0]
[[touch]]
start_s = 2
end_s = 5
angle_deg = 215
normal_n_per_m = [0, 20, 16, 0]
"""


def take_picture():
    """Of recorded fingers: simulated ones would say that they come late, on a machine that has much else to do."""
    with Bench(PROGRAM) as bench:
        for node, scenario in ((1, WIDE_SLIDE), (2, TWO)):
            bench.replayed(node, scenario, 50)
        _, url = bench.serve("-c", str(bench.folder / "config_1"))
        with browser.Page(url, 920, 770) as page:
            page.wait_for("cards.size === 2 && cards.get(1).points.length > 0 && newest.time_s - cards.get(1).points[0].t > 29.5", 90)
            page.wait_for("newest.fingers.every(finger => finger.touch?.touched) && newest.fingers[1].touch.second?.normal_n > .25", 20)
            page.screenshot(PICTURE)


if __name__ == "__main__":
    take_picture() if PICTURE else unittest.main()
