# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Progress, Ctrl-C, other threads of Python while a task runs."""

import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
from contextlib import redirect_stderr

import palmar

PRODUCTS = ["made: cylinder diameter_mm=35 length_mm=130", "made: prism fillet_mm=3"]


class WhileATaskRuns(unittest.TestCase):
    def test_progress_rises_to_the_end(self):
        heard = []
        palmar.assess(palmar.product.make("sphere", diameter_mm=50),
                      progress=lambda share, doing: heard.append((share, doing)))
        shares = [share for share, _ in heard]
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(shares and 0 <= shares[0] and shares[-1] <= 1)
        self.assertTrue(all(doing for _, doing in heard))

    def test_a_bar_is_drawn_on_stderr_and_taken_away(self):
        text = io.StringIO()
        with redirect_stderr(text):
            palmar.assess(palmar.product.make("sphere", diameter_mm=50), progress=True)
        self.assertRegex(text.getvalue(), r"\d+ % \[[#.]{24}\] ")
        self.assertEqual(text.getvalue().split("\r")[-1], "")

    def test_an_exception_of_progress_stops_the_task_and_comes_out(self):
        class Enough(Exception):
            pass

        def stop(share, doing):
            raise Enough(doing)

        with tempfile.TemporaryDirectory() as folder, self.assertRaises(Enough):
            palmar.study.run(products=PRODUCTS, hands=500, out=pathlib.Path(folder) / "s.palmar",
                             progress=stop)

    def test_other_threads_go_on(self):
        ticks, ended = [], threading.Event()

        def tick():
            while not ended.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        begin = time.monotonic()
        palmar.assess(palmar.product.make("prism"))
        spent = time.monotonic() - begin
        ended.set()
        thread.join()
        self.assertGreater(len(ticks), 10 * min(spent, 1))

    def test_ctrl_c_is_a_keyboard_interrupt_and_the_study_goes_on_later(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "s.palmar"
            script = textwrap.dedent(f"""
                import time, palmar
                try:
                    palmar.study.run(products={PRODUCTS!r}, hands=40, out={str(store)!r},
                                     progress=lambda share, doing: print(share, flush=True))
                except KeyboardInterrupt:
                    print("interrupted", flush=True)
            """)
            run = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
            while palmar_share(run.stdout.readline()) < 0.15:
                pass
            os.kill(run.pid, signal.SIGINT)
            begin = time.monotonic()
            rest, _ = run.communicate(timeout=60)
            self.assertLess(time.monotonic() - begin, 5)  # s; a grasp takes some 0.2 s
            self.assertEqual(rest.splitlines()[-1], "interrupted")
            self.assertEqual(run.returncode, 0)
            state = palmar.study.status(store)
            self.assertTrue(0 < state["done"] < state["total"] == 80)


def palmar_share(line):
    return float(line)


if __name__ == "__main__":
    unittest.main()
