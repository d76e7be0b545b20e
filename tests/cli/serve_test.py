"""`dismantle serve`: who is let in, and plans that are made, cancelled, changed and kept."""
import http.client
import json
import os
import signal
import socket
import subprocess
import threading
import time
import unittest
from urllib.parse import parse_qs, quote, urlsplit

from program import HANGING, PROGRAM, VIEWER, CliTest, box

HELP = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout


@unittest.skipUnless(" serve " in HELP, "built without cpp-httplib")
class Serve(CliTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("in"))

    def start(self, *options, folder="in"):
        """Starts a server; it is ended after the test."""
        server = subprocess.Popen([PROGRAM, "serve", folder, "--no-browser", *options], cwd=self.folder, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.stdout.close)
        watchdog = threading.Timer(HANGING, server.kill)
        watchdog.start()
        self.addCleanup(watchdog.cancel)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        address = urlsplit(server.stdout.readline().strip())
        self.assertEqual((address.scheme, address.hostname, address.path), ("http", "127.0.0.1", "/"))
        self.port, self.token = address.port, parse_qs(address.query)["token"][0]
        return server

    def end(self, server):
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(HANGING), 0, "being ended is what its user asked for")

    def request(self, method, path, body=None, headers=None, token=True):
        """Status, headers and content of the answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=HANGING)
        try:
            connection.request(method, path, body, {**({"X-Dismantle-Token": self.token} if token else {}), **(headers or {})})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def status(self, *arguments, **named):
        return self.request(*arguments, **named)[0]

    def ask(self, path, status=200, **question):
        method = "POST" if question else "GET"
        got, _, content = self.request(method, path, json.dumps(question) if question else None)
        self.assertEqual(got, status, content)
        return json.loads(content)

    def upload(self, name, content):
        return self.status("PUT", "/api/upload?name=" + quote(name, safe=""), content)

    def product(self, name):
        return self.ask("/api/product?name=" + quote(name))

    def names(self):
        return [p["name"] for p in self.ask("/api/state")["products"]]

    def wait(self, name, until=lambda job: job["state"] not in ("queued", "running")):
        """The product, as soon as its job is so."""
        end = time.monotonic() + HANGING
        while time.monotonic() < end:
            product = self.product(name)
            if until(product["job"]):
                return product
            time.sleep(0.05)
        self.fail(f"{name} hangs: {product}")

    def plan(self, name, **question):
        self.ask("/api/plan", name=name, **question)
        return self.wait(name)

    def test_only_its_own_page_with_the_token_is_let_in(self):
        self.start()
        page = self.request("GET", "/", token=False)
        self.assertEqual(page[0], 200)
        self.assertNotIn(self.token.encode(), page[2], "the page itself holds nothing")
        self.assertIn("default-src 'none'", page[1]["Content-Security-Policy"])
        self.assertNotIn(b"//cdn", page[2])
        for method, path in (("GET", "/api/state"), ("GET", "/api/product?name=x"), ("GET", "/plan/x/plan.json"), ("POST", "/api/plan"),
                             ("POST", "/"), ("PUT", "/api/upload?name=x.obj"), ("GET", "/nothing"), ("OPTIONS", "/api/state")):
            self.assertEqual(self.status(method, path, token=False), 401, path)
            self.assertEqual(self.status(method, path, headers={"X-Dismantle-Token": "0" * 32}), 401, path)
        self.assertEqual(self.status("GET", "/api/state?token=" + self.token, token=False), 200)
        self.assertEqual(self.status("GET", "/api/state", headers={"Origin": f"http://127.0.0.1:{self.port}"}), 200)
        for path in ("/", "/api/state"):
            for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{self.port}"}, {"Host": "127.0.0.1"}, {"Origin": "http://evil.example"},
                            {"Origin": "null"}, {"Origin": f"https://127.0.0.1:{self.port}"}):
                self.assertEqual(self.status("GET", path, headers=headers), 403, headers)
        self.assertEqual(self.status("POST", "/api/plan", "no json"), 400)
        self.assertEqual(self.status("POST", "/api/plan", "{}" + " " * 2_000_000), 413)

    def test_it_listens_on_the_loopback_only_and_takes_no_port_of_others(self):
        self.start()
        with open("/proc/net/tcp", encoding="ascii") as file:
            listening = [line.split()[1] for line in file.readlines()[1:] if line.split()[3] == "0A"]
        self.assertEqual([a for a in listening if int(a.split(":")[1], 16) == self.port], [f"0100007F:{self.port:04X}"])
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            self.assert_fails(2, f"port {other.getsockname()[1]} cannot be used", "serve", "in", "--no-browser", "--port", str(other.getsockname()[1]))
        self.assert_fails(2, f"port {self.port} cannot be used", "serve", "in", "--no-browser", "--port", str(self.port))
        self.assert_fails(3, "no folder", "serve", "nowhere", "--no-browser")
        self.assert_fails(2, "--port", "serve", "in", "--port", "70000")

    def test_no_path_leaves_the_folder(self):
        self.write("secret.obj", "secret")
        self.write("outside.plan/plan.json", "secret")
        os.symlink(self.path("secret.obj"), self.path("in", "link.obj"))
        os.symlink(self.path("outside.plan"), self.path("in", "link.plan"))
        self.write("in/pair/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("in/pair.plan/plan.json", "{}")
        os.symlink(self.path("secret.obj"), self.path("in", "pair.plan", "plan.glb"))
        self.start()
        self.assertEqual(self.names(), ["pair"])
        for path in ("/../secret.obj", "/plan/../secret.obj", "/plan/..%2f..%2fsecret.obj/plan.json", "/plan/..%2foutside/plan.json", "/plan/../plan.json",
                     "/plan/link/plan.json", "/plan/pair/..%2f..%2f..%2fsecret.obj", "/plan/pair/plan.glb", "/plan/pair/%2e%2e", "/plan/outside/plan.json"):
            got, _, content = self.request("GET", path)
            self.assertEqual((got, b"secret" in content), (404, False), path)
        for name in ("../secret", "..", "link", "/etc", "pair/a"):
            self.ask("/api/plan", status=404, name=name)
        for name in ("../new.obj", "/tmp/new.obj", "a/new.obj", "..", "", ".new.obj", "a\\new.obj", "a\nnew.obj"):
            self.assertEqual(self.upload(name, "x"), 400, name)
        self.assertEqual(self.upload("new.sh", "x"), 415)
        self.assertEqual(self.upload("link.obj", "x"), 409)
        self.assertEqual(self.read("secret.obj"), "secret")
        self.assertEqual(sorted(os.listdir(self.folder)), ["in", "outside.plan", "secret.obj"])
        self.assertEqual(sorted(os.listdir(self.path("in"))), ["link.obj", "link.plan", "pair", "pair.plan"], "nothing is left of what was refused")

    def test_files_are_uploaded_once_and_not_above_the_limit(self):
        self.start("--max-upload", "1")
        self.assertEqual(self.upload("gear.stl", b"a" * 1_000_000), 201)
        self.assertEqual(self.names(), ["gear"])
        for name in ("gear.stl", "gear.obj"):
            self.assertEqual(self.upload(name, "b"), 409, "nothing is written over")
        self.assertEqual(self.upload("large.stl", b"a" * 1_000_001), 413)
        chunks = (b"a" * 100_000 for _ in range(11))
        self.assertEqual(self.status("PUT", "/api/upload?name=chunks.stl", chunks), 413)
        self.assertEqual(os.listdir(self.path("in")), ["gear.stl"])
        self.assertEqual(os.path.getsize(self.path("in", "gear.stl")), 1_000_000)

    def test_a_plan_is_that_of_the_command_line_and_is_kept_over_a_restart(self):
        self.run_program("sample", "peg_in_hole", "-o", "in/peg", "-q", status=0)
        server = self.start()
        self.assertEqual([(p["name"], p["has_plan"]) for p in self.ask("/api/state")["products"]], [("peg", False)])
        self.assertEqual(self.status("GET", "/plan/peg/plan.json"), 404)
        product = self.plan("peg", timeout=60)
        self.assertEqual((product["job"]["state"], product["job"]["status"]), ("done", "complete"), product)
        self.assertEqual((product["plan"]["status"], product["plan"]["parts"], product["plan"]["steps"]), ("complete", 2, 1))
        self.run_program("plan", "in/peg", "--timeout", "60", "-o", "alone", "-q", status=0)
        got, _, content = self.request("GET", "/plan/peg/plan.json")
        self.assertEqual(got, 200)
        self.assertEqual([s["moves"] for s in json.loads(content)["disassembly"]],
                         [s["moves"] for s in json.loads(self.read("alone", "plan.json"))["disassembly"]])
        self.assertEqual(self.request("GET", "/plan/peg/resolved.yaml")[2].decode(), self.read("in", "peg.plan", "resolved.yaml"))
        if VIEWER:
            got, headers, content = self.request("GET", "/plan/peg/index.html")
            self.assertEqual((got, content.decode()), (200, self.read("in", "peg.plan", "index.html")))
            self.assertIn("sandbox allow-scripts", headers["Content-Security-Policy"])
            self.assertNotIn("allow-same-origin", headers["Content-Security-Policy"])
        self.end(server)
        old = self.token
        self.start()
        self.assertNotEqual(self.token, old)
        again = self.product("peg")
        self.assertEqual([again[k] for k in ("plan", "steps", "parts")], [product[k] for k in ("plan", "steps", "parts")])
        self.run_program("verify", "in/peg.plan/plan.json", "-q", status=0)

    def test_what_cannot_be_planned_says_why_and_leaves_the_plan(self):
        self.write("in/broken.obj", "v 0 0 zero\n")
        self.write("in/broken.plan/plan.json", "{}")
        self.start()
        product = self.plan("broken")
        self.assertEqual(product["job"]["state"], "failed")
        self.assertIn("broken.obj", product["job"]["message"])
        self.assertIn("plan.json cannot be read", product["problem"])
        self.assertEqual(sorted(os.listdir(self.path("in"))), ["broken.obj", "broken.plan"])
        for timeout in (0, -1, 1e9, "soon"):
            self.ask("/api/plan", status=400, name="broken", timeout=timeout)
        for up in ("up", 3, "0,0,0", "x --help"):
            self.ask("/api/plan", status=400, name="broken", up=up)
        self.ask("/api/plan", status=404, name="nothing")

    def test_a_running_job_is_cancelled_and_a_waiting_one_too(self):
        self.run_program("sample", "machine", "-o", "in/work", "--set", "parts=160", "-q", status=0)  # seconds of work
        self.run_program("sample", "peg_in_hole", "-o", "in/peg", "-q", status=0)
        server = self.start()
        self.ask("/api/plan", name="work")
        self.ask("/api/plan", name="peg")
        self.wait("work", lambda job: job["state"] == "running" and job["progress"])
        self.ask("/api/plan", status=409, name="work")
        self.assertEqual(self.product("peg")["job"]["state"], "queued")
        self.ask("/api/cancel", name="peg")
        self.ask("/api/cancel", name="work")
        self.assertEqual(self.wait("work")["job"]["state"], "cancelled")
        self.assertEqual(self.wait("peg")["job"]["state"], "cancelled")
        self.ask("/api/cancel", status=409, name="peg")
        self.assertEqual(sorted(os.listdir(self.path("in"))), ["peg", "work"], "nothing is left of it")
        self.assertEqual(self.plan("peg")["job"]["state"], "done", "the server goes on")
        self.ask("/api/plan", name="work")
        self.wait("work", lambda job: job["state"] == "running")
        self.end(server)

    def blocks(self):
        """Four blocks beside each other on a plate, planned."""
        for k in range(4):
            self.write(f"in/blocks/block_{k}.obj", box((3 * k, 0, 1), (3 * k + 2, 2, 3)))
        self.write("in/blocks/plate.obj", box((0, 0, 0), (11, 2, 1)))
        self.start()
        return self.plan("blocks", timeout=60)

    def test_a_step_is_moved_and_the_move_undone(self):
        order = [s["parts"] for s in self.blocks()["steps"]]
        self.ask("/api/move", name="blocks", step=4, before=2)
        product = self.wait("blocks")
        self.assertEqual((product["job"]["kind"], product["job"]["state"], product["earlier"]), ("edit", "done", 1), product["job"])
        self.assertEqual([s["parts"] for s in product["steps"]], [order[0], order[3], order[1], order[2]])
        self.run_program("verify", "in/blocks.plan/plan.json", "-q", status=0)
        self.ask("/api/undo", name="blocks")
        product = self.product("blocks")
        self.assertEqual(([s["parts"] for s in product["steps"]], product["earlier"]), (order, 0))
        self.run_program("verify", "in/blocks.plan/plan.json", "-q", status=0)
        self.ask("/api/undo", status=409, name="blocks")

    def test_a_job_that_is_done_has_changed_all_that_is_told(self):
        self.blocks()
        for i in range(3000):  # so that it takes a while to look through the folder
            self.write(f"in/z{i}.obj", "")
        moves, moved, stop, wrong = 4, [0], threading.Event(), []

        def watch():
            while not stop.is_set():
                least = moved[0]
                product = self.product("blocks")
                if product["job"]["kind"] == "edit" and product["job"]["state"] == "done" and product["earlier"] < least:
                    wrong.append((least, product["earlier"]))

        watchers = [threading.Thread(target=watch) for _ in range(4)]
        for w in watchers:
            w.start()
        try:
            for i in range(moves):
                self.ask("/api/move", name="blocks", step=4 if i % 2 == 0 else 2, **({"before": 2} if i % 2 == 0 else {"after": 4}))
                moved[0] = i + 1
                self.assertEqual(self.wait("blocks")["job"]["state"], "done")
        finally:
            stop.set()
            for w in watchers:
                w.join()
        self.assertEqual(wrong, [])

    def test_a_move_that_is_not_possible_names_the_step_and_changes_nothing(self):
        self.run_program("sample", "stacked_box", "-o", "in/box", "-q", status=0)
        self.start()
        self.plan("box", timeout=60)
        before = self.read("in", "box.plan", "plan.json")
        plan = json.loads(before)["disassembly"]
        waiting = next(s for s in plan if s.get("after"))
        number = {s["step"]: len(plan) + 1 - s["step"] for s in plan}  # of the assembly
        self.ask("/api/move", name="box", step=number[waiting["step"]], after=number[max(waiting["after"])])
        product = self.wait("box")
        self.assertEqual(product["job"]["state"], "refused", product["job"])
        self.assertIn(product["job"]["step"], number.values())
        self.assertTrue(product["job"]["message"])
        self.assertEqual(self.read("in", "box.plan", "plan.json"), before)
        self.assertEqual(product["earlier"], 0)
        for wrong in ({"step": 0, "after": 1}, {"step": 1}, {"step": "1", "before": 2}, {"step": 1, "before": -1}):
            self.ask("/api/move", status=400, name="box", **wrong)
        self.ask("/api/move", name="box", step=1, before=99)
        self.assertEqual(self.wait("box")["job"]["state"], "failed")

    def test_marked_parts_are_constraints_of_the_command_line(self):
        self.blocks()
        self.write("in/blocks.yaml", "schema: 1\nrun: {seed: 7}\n")
        chosen = {"base": ["plate"], "ignore": ["block_3"], "together": [["block_0", "block_1"]]}
        self.ask("/api/constraints", name="blocks", constraints=chosen)
        self.assertEqual(self.product("blocks")["constraints"], chosen)
        product = self.plan("blocks", timeout=60)
        self.assertEqual((product["job"]["state"], product["job"]["status"]), ("done", "complete"), product)
        self.assertEqual(sorted(sorted(s["parts"]) for s in product["steps"]), [["block_0", "block_1"], ["block_2"]])
        self.assertIn("block_3", product["parts"], "what is left out can be taken in again")
        self.assertEqual(product["yaml"], self.read("in", "blocks.constraints.yaml"))
        self.run_program("plan", "in/blocks", "-c", "in/blocks.constraints.yaml", "--timeout", "60", "-o", "alone", "-q", status=0)
        served, alone = (json.loads(self.read(*f, "plan.json")) for f in (("in", "blocks.plan"), ("alone",)))
        self.assertEqual((served["seed"], served["disassembly"][0]["moves"]), (7, alone["disassembly"][0]["moves"]))
        for wrong in ({"base": ["nobody"]}, {"run": {"seed": 1}}, {"base": "plate"}, []):
            self.ask("/api/constraints", status=400, name="blocks", constraints=wrong)
        self.ask("/api/constraints", name="blocks", constraints={"base": ["plate"], "target": "plate"})
        product = self.plan("blocks", timeout=60)
        self.assertEqual(product["job"]["state"], "failed", "a contradiction")
        self.assertIn("plate", product["job"]["message"])
        self.ask("/api/constraints", name="blocks", constraints={})
        self.assertFalse(os.path.exists(self.path("in", "blocks.constraints.yaml")))
        self.assertEqual(len(self.plan("blocks", timeout=60)["steps"]), 4)

    def test_a_forced_step_is_accepted(self):
        self.run_program("sample", "snap_fit", "-o", "in/clip", "-q", status=0)
        self.start()
        product = self.plan("clip", timeout=60)
        self.assertEqual((product["job"]["state"], product["job"]["status"]), ("done", "forced"), product["job"])
        cut = product["steps"][0]["cut"]
        self.assertEqual((cut["part"], cut["against"], cut["accepted"]), ("clip", "plate", ""))
        accept = [{"part": cut["part"], "against": cut["against"], "as": "snap", "depth": 1.1 * cut["depth"]}]
        self.ask("/api/constraints", name="clip", constraints={"accept": accept})
        product = self.plan("clip", timeout=60)
        self.assertEqual((product["job"]["status"], product["constraints"]["accept"]), ("complete", accept), product["job"])
        self.assertEqual(product["steps"][0]["cut"]["accepted"], "snap")

    @unittest.skipUnless(" book " in HELP, "built without pango")
    def test_instructions_are_written_beside_the_plan_and_go_with_it(self):
        self.blocks()
        self.write("in/blocks.notes.yaml", "notes: [{parts: [block_1], text: Mind the paint.}]\n")
        self.assertEqual(self.status("GET", "/plan/blocks/book.pdf"), 404)
        self.ask("/api/book", name="blocks")
        product = self.wait("blocks")
        self.assertEqual((product["job"]["kind"], product["job"]["state"], product["has_book"]), ("book", "done", True), product["job"])
        status, headers, content = self.request("GET", "/plan/blocks/book.pdf")
        self.assertEqual((status, headers["Content-Type"], content[:5]), (200, "application/pdf", b"%PDF-"))
        self.assertEqual(len(product["steps"]), 4, "the plan is still there")
        self.ask("/api/move", name="blocks", step=4, before=2)
        product = self.wait("blocks")
        self.assertEqual((product["job"]["state"], product["has_book"]), ("done", False), "the instructions were for the other order")
        self.assertIn("it costs ", product["job"]["costs"])
        self.ask("/api/undo", name="blocks")
        self.assertTrue(self.product("blocks")["has_book"])
        self.write("in/pair/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.ask("/api/book", status=409, name="pair")


if __name__ == "__main__":
    unittest.main()
