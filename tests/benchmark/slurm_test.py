"""`--launcher slurm` on a real Slurm: one node, started here with its own configuration, ports and authentication, and stopped
again. Debian's slurm-wlm and munge, which tools/packages.txt has. Tasks that are killed and nodes that go down cost nothing but the
trials that ran."""
import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
import unittest

from benching import BenchTest

NEEDED = ("sbatch", "squeue", "sinfo", "slurmctld", "slurmd", "munged", "munge")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
PATIENCE = 60  # seconds for what the daemons have to do


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Slurm(BenchTest):
    def setUp(self):
        super().setUp()
        missing = [name for name in NEEDED if shutil.which(name, path=PATH) is None]
        self.assertEqual(missing, [], "not installed (Debian: apt-get install slurm-wlm munge)")
        self.daemons = []
        self.addCleanup(self.stop_daemons)
        os.makedirs(self.path("slurm"), mode=0o755)
        os.chmod(self.folder, 0o755)
        self.env = {**os.environ, "PATH": PATH, "SLURM_CONF": self.path("slurm/slurm.conf")}
        self.start_munge()
        self.start_slurm()

    def stop_daemons(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()

    def daemon(self, *command):
        with open(self.path("slurm", os.path.basename(command[0]) + ".out"), "w") as log:
            self.daemons.append(subprocess.Popen(command, env=self.env, stdin=subprocess.DEVNULL, stdout=log, stderr=log))

    def output(self, *command):
        done = subprocess.run(command, env=self.env, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else ""

    def logs(self):
        """The ends of what the daemons have written."""
        return "".join(self.read("slurm", n)[-1500:] for n in os.listdir(self.path("slurm")) if n.endswith((".out", ".log")))

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end or any(d.poll() is not None for d in self.daemons):
                self.fail(f"{what}:\n{self.logs()}\n{self.output('squeue')}\n{self.output('sinfo')}")
            time.sleep(0.1)

    def start_munge(self):
        key, sock = self.path("slurm/munge.key"), self.path("slurm/munge.sock")
        with open(key, "wb") as file:
            file.write(os.urandom(1024))
        os.chmod(key, 0o400)
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={sock}",
                    f"--pid-file={self.path('slurm/munged.pid')}", f"--log-file={self.path('slurm/munged.log')}",
                    f"--seed-file={self.path('slurm/munged.seed')}")
        self.wait_for("MUNGE does not start", lambda: self.output("munge", "-S", sock, "-n"))

    def start_slurm(self):
        host, user = socket.gethostname().split(".")[0], getpass.getuser()
        here, (control, node) = self.path("slurm"), free_ports(2)
        for folder in ("state", "spool"):
            os.makedirs(os.path.join(here, folder))
        with open(os.path.join(here, "cgroup.conf"), "w") as file:
            file.write("CgroupPlugin=cgroup/v1\n")
        with open(os.path.join(here, "slurm.conf"), "w") as file:
            file.write(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={control}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={here}/munge.sock
CredType=cred/munge
StateSaveLocation={here}/state
SlurmdSpoolDir={here}/spool
SlurmctldPidFile={here}/slurmctld.pid
SlurmdPidFile={here}/slurmd.pid
SlurmctldLogFile={here}/slurmctld.log
SlurmdLogFile={here}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
KillWait=1
ReturnToService=2
SlurmdTimeout=5
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        self.daemon("slurmctld", "-D")
        self.start_node()
        self.wait_for("Slurm does not start", lambda: "idle" in self.output("sinfo", "-h", "-o", "%T"))

    def start_node(self):
        self.daemon("slurmd", "-D", "-N", socket.gethostname().split(".")[0])
        self.node = self.daemons[-1]

    def submit(self, tasks):
        done = subprocess.run([os.environ["DISMANTLE"], "bench", "suite.yaml", "-o", "out", "--launcher", "slurm", "--tasks", str(tasks),
                               "--slurm-option=--partition=all"], cwd=self.folder, env=self.env, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, rf"submitted as Slurm job \d+, {tasks} tasks")

    def wait_for_jobs(self):
        self.wait_for("jobs do not end", lambda: not self.output("squeue", "-h"))

    def sizes(self, tasks):
        """How many rows each shard has; each trial once, all done."""
        logs = "".join(self.read("out", n) for n in os.listdir(self.path("out")) if n.endswith(".log"))
        sizes = []
        for i in range(1, tasks + 1):
            name = f"out/shard-{i}-of-{tasks}.db"
            self.assertTrue(os.path.exists(self.path(name)), logs)
            sizes.append(len(self.rows(database=name)))
            self.assertEqual(self.rows("SELECT id FROM trials WHERE state <> 'done'", database=name), [], logs + self.logs())
            self.assert_each_once(sizes[-1], database=name)
        return sizes

    def processes(self, condition):
        """Ids of processes with these words on their command line."""
        found = []
        for name in os.listdir("/proc"):
            try:
                with open(f"/proc/{name}/cmdline", "rb") as file:
                    words = file.read().split(b"\0")
            except OSError:
                continue  # no process, or it has ended
            if condition(words):
                found.append(int(name))
        return found

    def shards_here(self):
        return self.processes(lambda words: b"--shard" in words and any(self.folder.encode() in word for word in words))

    def processes_named(self, program):
        return self.processes(lambda words: program.encode() in words[0])

    def done(self, tasks):
        databases = [f"out/shard-{i}-of-{tasks}.db" for i in range(1, tasks + 1)]
        there = [d for d in databases if os.path.exists(self.path(d))
                 and self.rows("SELECT name FROM sqlite_master WHERE name = 'trials'", database=d)]
        return sum(len(self.rows("SELECT id FROM trials WHERE state = 'done'", database=d)) for d in there)

    def test_an_array_of_shards_is_the_whole_suite(self):
        self.suite(self.evil("none", "abort"), more="seeds: 1..4\n")
        self.submit(3)
        self.wait_for_jobs()
        self.assertEqual(self.sizes(3), [3, 3, 2])
        report = self.call("report", "out", "--table", "outcomes").stdout
        self.assertIn("8 trials, 2 planners", report)

    def test_a_killed_task_goes_on_when_it_is_submitted_again(self):
        self.suite(self.evil("sleep"), more="seeds: 1..6\n", limits="timeout: 1, wall: 2, memory: 2048")
        self.submit(2)
        self.wait_for("no trial ends", lambda: self.done(2) > 0)
        for process in self.shards_here():
            os.kill(process, signal.SIGKILL)
        self.wait_for_jobs()
        self.assertLess(self.done(2), 6)
        self.submit(2)
        self.wait_for_jobs()
        self.assertEqual(self.sizes(2), [3, 3])

    def test_a_node_that_goes_down_and_comes_back(self):
        self.suite(self.evil("sleep"), more="seeds: 1..10\n", limits="timeout: 1, wall: 2, memory: 2048")
        self.submit(2)
        self.wait_for("no trial ends", lambda: self.done(2) > 0)
        # The node dies: its daemon, and all that it has started.
        self.daemons.remove(self.node)
        self.node.kill()
        self.node.wait()
        for process in self.shards_here() + self.processes_named("slurmstepd"):
            os.kill(process, signal.SIGKILL)
        self.wait_for("the node is not missed", lambda: "down" in self.output("sinfo", "-h", "-o", "%T"))
        self.assertLess(self.done(2), 10)
        self.start_node()
        self.wait_for("the node does not come back", lambda: "idle" in self.output("sinfo", "-h", "-o", "%T"))
        # Slurm has queued the tasks again by itself, for two minutes later; here they are submitted again instead.
        self.assertEqual(len(self.output("squeue", "-h", "-r", "-t", "PENDING", "-o", "%i").split()), 2)
        self.output("scancel", "--user", getpass.getuser())
        self.wait_for_jobs()
        self.submit(2)
        self.wait_for_jobs()
        self.assertEqual(self.sizes(2), [5, 5])


if __name__ == "__main__":
    unittest.main()
