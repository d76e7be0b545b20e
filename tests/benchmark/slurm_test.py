"""`--launcher slurm` on a real Slurm: one node, started here with its own configuration, ports and authentication, and stopped
again. Skipped where Slurm or MUNGE is not installed (Debian: slurm-wlm, munge) or does not start."""
import getpass
import os
import shutil
import socket
import subprocess
import time
import unittest

from benching import BenchTest

NEEDED = ("sbatch", "squeue", "sinfo", "slurmctld", "slurmd", "munged", "munge")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
PATIENCE = 60  # seconds for daemons to come up before the test is skipped


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
        if missing:
            self.skipTest(f"not installed: {', '.join(missing)} (Debian: apt-get install slurm-wlm munge)")
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

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end or any(d.poll() is not None for d in self.daemons):
                logs = "".join(self.read("slurm", n)[-1500:] for n in os.listdir(self.path("slurm")) if n.endswith((".out", ".log")))
                self.skipTest(f"{what} does not start here:\n{logs}")
            time.sleep(0.1)

    def start_munge(self):
        key, sock = self.path("slurm/munge.key"), self.path("slurm/munge.sock")
        with open(key, "wb") as file:
            file.write(os.urandom(1024))
        os.chmod(key, 0o400)
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={sock}",
                    f"--pid-file={self.path('slurm/munged.pid')}", f"--log-file={self.path('slurm/munged.log')}",
                    f"--seed-file={self.path('slurm/munged.seed')}")
        self.wait_for("MUNGE", lambda: self.output("munge", "-S", sock, "-n"))

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
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D", "-N", host)
        self.wait_for("Slurm", lambda: "idle" in self.output("sinfo", "-h", "-o", "%T"))

    def test_an_array_of_shards_is_the_whole_suite(self):
        self.suite(self.evil("none", "abort"), more="seeds: 1..4\n")
        done = subprocess.run([os.environ["DISMANTLE"], "bench", "suite.yaml", "-o", "out", "--launcher", "slurm", "--tasks", "3",
                               "--slurm-option=--partition=all"], cwd=self.folder, env=self.env, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"submitted as Slurm job \d+, 3 tasks")
        while self.output("squeue", "-h"):
            time.sleep(0.2)
        logs = "".join(self.read("out", n) for n in os.listdir(self.path("out")) if n.endswith(".log"))
        sizes = []
        for i in (1, 2, 3):
            self.assertTrue(os.path.exists(self.path(f"out/shard-{i}-of-3.db")), logs)
            sizes.append(len(self.rows(database=f"out/shard-{i}-of-3.db")))
            self.assert_each_once(sizes[-1], database=f"out/shard-{i}-of-3.db")
        self.assertEqual(sizes, [3, 3, 2])
        report = self.call("report", "out", "--table", "outcomes").stdout
        self.assertIn("8 trials, 2 planners", report)


if __name__ == "__main__":
    unittest.main()
