#!/usr/bin/python3
"""Installs the packages of `make package` in a bare Debian 12 and uses them there as an unprivileged user.

    tests/packaging/package_test.py [--packages build/package] [--root build/package/root] [--arch amd64] [--camera]

The root is made by debootstrap, kept as ROOT.tar for the next call, and unpacked again for each call. --arch arm64 runs its programs by qemu-user, which
needs binfmt. --camera also installs faba-camera with its 360 packages. Needs root for chroot. Exit code 77: nothing failed, but checks could not run.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parents[2]
USER = "visitor"
NATIVE = subprocess.run(["dpkg", "--print-architecture"], check=True, capture_output=True, text=True).stdout.strip()
PYTHON = "/usr/bin/python3"
# Small pictures at two frames per second, which an emulator can render in time.
SLOW_BENCH = ("--duration '12 s' --set 'camera.rate=2 Hz' --set 'swarm[0].count=30' --set 'arena.view_px=[128, 96]' --set arena.radius_px=40 "
              "--set 'arena.centre_px=[64, 48]' --set 'swarm[0].start={type = \"disc\", centre_px = [46, 48], radius_px = 6}' --set 'reference.setpoint_px=[80, 48]'")
# State of the package manager, logs and caches: not what a package installs.
NOT_OF_PACKAGES = re.compile(r"^/(proc|sys|dev|tmp|run|home|root|packages)/|^/var/(lib|cache|log)/")


class Failed(Exception):
    pass


class Skipped(Exception):
    pass


class Root:
    """A Debian root in a folder, of which the programs are run by chroot."""

    def __init__(self, folder, arch):
        self.folder, self.arch = folder, arch

    def make(self):
        if os.geteuid() != 0:
            raise Skipped("chroot needs root; run this test as root")
        if not shutil.which("debootstrap"):
            raise Skipped("debootstrap not found; `tools/setup.sh package` installs it")
        able = subprocess.run([*self.namespaces(), "/bin/sh", "-c", "mount -t proc proc /proc && mount --rbind /dev /dev"], capture_output=True, text=True)
        if able.returncode:
            raise Skipped(f"no namespaces with mounts of their own here: {able.stderr.strip().removeprefix('SKIPPED: ')}")
        tar = self.folder.with_suffix(f".{self.arch}.tar")
        shutil.rmtree(self.folder, ignore_errors=True)
        if not tar.exists():
            self.bootstrap()
            subprocess.run(["tar", "-C", self.folder, "-cf", tar, "."], check=True)
        else:
            self.folder.mkdir(parents=True)
            subprocess.run(["tar", "-C", self.folder, "-xf", tar], check=True)
        # Packages come from where this machine has its own.
        for name in ("etc/apt/sources.list", "etc/apt/sources.list.d/debian.sources", "etc/resolv.conf"):
            if pathlib.Path("/", name).exists():
                shutil.copy(pathlib.Path("/", name), self.folder / name)
        for name in pathlib.Path("/etc/apt/apt.conf.d").iterdir():
            if re.search(r"Acquire", name.read_text()):
                shutil.copy(name, self.folder / "etc/apt/apt.conf.d")

    def bootstrap(self):
        foreign = [] if self.arch == NATIVE else ["--foreign"]
        stages = [["debootstrap", "--variant=minbase", f"--arch={self.arch}", *foreign, "bookworm", self.folder]]
        if foreign:  # container=lxc: no devices are made, which a user namespace does not permit
            stages.append([*self.namespaces(), "/bin/sh", "-c", f"mount -t proc proc {self.folder}/proc; "
                           f"exec env container=lxc /usr/sbin/chroot {self.folder} /debootstrap/debootstrap --second-stage"])
        for words in stages:
            done = subprocess.run(words, capture_output=True, text=True)
            if done.returncode:
                raise Skipped(f"debootstrap failed: {(done.stdout + done.stderr).strip().splitlines()[-1]}")

    def namespaces(self):
        """The words before a command that give it its own mounts and processes, and for arm64 the emulation."""
        if self.arch == NATIVE:
            return ["/usr/bin/unshare", "--mount", "--pid", "--fork", "--kill-child"]
        return [PYTHON, str(HERE / "tests/packaging/arm64_namespace.py")]

    def run(self, command, user=None, cwd="/", check=True, env=None, timeout=900, network=True):
        """Runs a shell command in the root, in a namespace with its own /proc. Returns the finished process."""
        shell = f"cd {cwd} || exit 1; {command}"
        if user:
            shell = f"exec setpriv --reuid={user} --regid={user} --clear-groups -- /bin/sh -c {quoted(shell)}"
        words = [*([] if network else ["/usr/bin/unshare", "--net"]), *self.namespaces(), "/bin/sh", "-c",
                 f"/bin/mount -t proc proc {self.folder}/proc; /bin/mount -t tmpfs tmpfs {self.folder}/run; /bin/mount --rbind /dev {self.folder}/dev; "
                 f"exec /usr/sbin/chroot {self.folder} /bin/bash -c {quoted(shell)}"]
        variables = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive", "HOME": f"/home/{user}" if user else "/root"}
        done = subprocess.run(words, capture_output=True, text=True, env=variables if env is None else env, timeout=timeout)
        if check and done.returncode:
            raise Failed(f"`{command}` ended with exit code {done.returncode}:\n{(done.stdout + done.stderr)[-2000:]}")
        return done

    def files(self):
        listed = self.run("find / -xdev -not -type d -print").stdout.splitlines()
        return {name for name in listed if not NOT_OF_PACKAGES.search(name)}


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


class Checks:
    def __init__(self, root):
        self.root, self.failed, self.skipped = root, 0, 0
        self.folder = f"/home/{USER}/empty"

    def use(self, command, **more):
        return self.root.run(command, user=USER, cwd=self.folder, **more)

    def check(self, what, test):
        try:
            print(f"ok {what}: {test() or ''}", flush=True)
        except Skipped as reason:
            self.skipped += 1
            print(f"SKIPPED {what}: {reason}", flush=True)
        except (Failed, AssertionError, subprocess.TimeoutExpired, ValueError, KeyError) as error:
            self.failed += 1
            print(f"FAILED {what}: {type(error).__name__}: {error}", flush=True)


def state_hash(text):
    found = re.search(r"state_hash\W+([0-9a-f]{16})", text)
    assert found, f"no state hash in {text[-500:]}"
    return found[1]


def install(root, packages, folder, before):
    root.run("apt-get update -qq && apt-get install -y -qq --no-install-recommends man-db bash-completion")
    root.run(f"useradd --create-home {USER} && install -d -o {USER} {folder}")
    before |= root.files()
    target = root.folder / "packages"
    target.mkdir(exist_ok=True)
    for file in packages.glob(f"*_{root.arch}.deb"):
        shutil.copy(file, target)
    done = root.run("apt-get install -y --no-install-recommends /packages/faba_*.deb")
    return re.search(r"(\d+) newly installed", done.stdout)[0]


def check_run(c):
    here = subprocess.run([HERE / "build/faba", "run", "steer", "--seed", "1", "--out", str(c.root.folder.parent / "here"), "--force", "--json"],
                          capture_output=True, text=True, check=True)
    there = c.use("faba run steer --seed 1 --json", timeout=1800)
    assert state_hash(here.stdout) == state_hash(there.stdout), "the state hash differs from that of build/faba"
    assert c.use("ls runs").stdout.split() == ["steer-1"]
    return f"state hash {state_hash(there.stdout)}, equal to that of build/faba"


def check_lab(c):
    command = ("faba lab --no-browser --json > lab.json 2> lab.err & lab=$!; for i in $(seq 300); do [ -s lab.json ] && break; sleep 0.1; done; "
               f"{PYTHON} -c 'import http.cookiejar, json, urllib.request as u; a = json.load(open(\"lab.json\"))[\"address\"]; "
               "o = u.build_opener(u.HTTPCookieProcessor(http.cookiejar.CookieJar())); page = o.open(a).read().decode(); "
               "scenes = json.load(o.open(a.split(\"/?\")[0] + \"/api/scenes\")); print(len(page), \"<title>\" in page, len(json.dumps(scenes)), \"steer\" in json.dumps(scenes))'; "
               "code=$?; kill $lab; wait $lab; exit $code")
    words = c.use(command).stdout.split()
    assert words[1] == "True" and words[3] == "True", words
    return f"the page has {words[0]} bytes, and the gallery has the installed scenes"


def check_bench(c):
    options = "--duration '3 s'" if c.root.arch == NATIVE else SLOW_BENCH
    ran = c.use(f"faba rig run bench --arm {options} --out runs/bench --json", check=False)
    if c.root.arch != NATIVE and re.search("control cycle overran|too slow for the frame rate", ran.stderr):
        raise Skipped(f"the emulator is too slow for a bench: {ran.stderr.strip().splitlines()[-1]}")
    if ran.returncode:
        raise Failed(ran.stderr)
    done = json.loads(ran.stdout)
    assert c.use("test -s runs/bench/coils.log && echo yes").stdout.strip() == "yes", "no log of the coils"
    return f"{done['frames']} frames with the guard of the package"


def check_python(c):
    out = c.use(f"{PYTHON} -c 'import faba; s = faba.Simulation(\"steer\", seed=1, set={{\"duration\": \"1 s\"}}); s.run(); print(faba.__file__, s.state_hash)'").stdout.split()
    assert out[0].startswith("/usr/lib/python3/dist-packages/faba/"), out
    program = state_hash(c.use("faba run steer --seed 1 --duration '1 s' --out runs/short --json").stdout)
    assert out[1] == program, f"Python has {out[1]}, the program {program}"
    return f"the same state hash as the program, {program}"


def check_environment(c):
    out = c.use(f"{PYTHON} -m venv --system-site-packages --without-pip environment && environment/bin/python -c 'import faba; print(faba.__file__)'").stdout
    assert "/usr/lib/python3/dist-packages" in out, out
    return "a virtual environment with system packages has it"


def check_manual(c):
    # minbase excludes manual pages by a setting of dpkg only in containers; man must show the page itself.
    out = c.use("man faba | head -20; man faba-run | head -20").stdout
    assert "laboratory for magnetotactic bacteria" in out and "faba run" in out, out
    return "man faba, man faba-run"


def check_completion(c):
    script = (". /usr/share/bash-completion/bash_completion; _completion_loader faba; COMP_WORDS=(faba run ste); COMP_CWORD=2; COMP_LINE=\"faba run ste\"; "
              "COMP_POINT=12; _faba; echo ${COMPREPLY[*]}")
    out = c.use(f"bash -c {quoted(script)}").stdout.split()
    assert "steer" in out, out
    return f"faba run ste -> {' '.join(out)}"


def check_examples(c):
    c.use("faba init first && cd first && faba run scenes/thesis-basic.toml --duration '1 s' --quiet && faba field map rigs/helmholtz.toml --current 1,0 --quiet")
    done = c.use("faba init first", check=True).stdout
    assert "examples" in done
    c.use("echo '# mine' >> first/scenes/steer.toml")
    refused = c.use("faba init first", check=False)
    assert refused.returncode == 2 and "--force" in refused.stderr, refused.stderr
    return "copied, run, and a changed copy is not replaced"


def check_doctor(c):
    parts = {p["name"]: p for p in json.loads(c.use("faba doctor --json").stdout)["parts"]}
    assert parts["coil guard"]["note"] == "/usr/libexec/faba/faba-coil-guard" and parts["examples"]["present"] and parts["FFmpeg"]["present"], parts
    assert not parts["camera module"]["present"] and "faba-camera" in parts["camera module"]["note"], parts
    return "guard, FFmpeg and examples found; the missing camera module is named"


def check_hostile(c):
    bare = {"PATH": "/usr/bin:/bin"}
    c.use("faba run steer --duration '1 s' --out runs/bare --quiet", env=bare)
    c.use(f"{PYTHON} -c 'import faba'", env=bare)
    read_only = c.root.run("faba run steer --duration '1 s'", user=USER, cwd="/usr", check=False)
    assert read_only.returncode not in (0, 139) and "Permission denied" in read_only.stderr and "--out" in read_only.stderr, read_only.stderr
    lab = c.root.run("timeout 3 faba lab", user=USER, cwd="/usr", check=False)
    assert lab.returncode == 124 or "error" in lab.stderr, lab.stderr
    assert c.use(f"{PYTHON} -c 'import socket; print(len(socket.if_nameindex()))'", network=False).stdout.strip() == "1", "there is a network"
    c.use("faba run steer --duration '1 s' --out runs/alone --quiet", network=False)
    return f"no HOME; no network; no display; read-only folder: {read_only.stderr.strip().splitlines()[-1]}"


def check_camera(c):
    c.root.run("apt-get install -y -qq --no-install-recommends /packages/faba-camera_*.deb", timeout=1500)
    parts = {p["name"]: p for p in json.loads(c.use("faba doctor --json").stdout)["parts"]}
    assert parts["camera module"]["present"], parts["camera module"]
    return "faba doctor finds the camera module"


def check_removal(c, before):
    c.root.run("apt-get purge -y -qq faba faba-camera && apt-get autoremove --purge -y -qq", timeout=900)
    left = sorted(c.root.files() - before)
    assert not left, f"{len(left)} files are left, such as {left[:5]}"
    folders = [f for f in c.root.run("find / -xdev -iname '*faba*'").stdout.splitlines() if not re.match(r"/(packages|home|tmp)/|/proc/", f)]
    assert not folders, folders
    return "no file is left"


def main():
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("--packages", type=pathlib.Path, default=HERE / "build/package")
    cli.add_argument("--root", type=pathlib.Path, default=HERE / "build/package/root")
    cli.add_argument("--arch", default="amd64", choices=("amd64", "arm64"))
    cli.add_argument("--camera", action="store_true")
    o = cli.parse_args()
    root = Root(o.root.resolve(), o.arch)
    before = set()
    try:
        root.make()
    except Skipped as reason:
        print(f"SKIPPED all checks: {reason}")
        return 77
    c = Checks(root)
    c.check("apt installs faba", lambda: install(root, o.packages, c.folder, before))
    if c.failed:
        return 1
    for what, test in (("faba run", check_run), ("faba lab", check_lab), ("faba rig run on a simulated bench", check_bench), ("import faba", check_python),
                       ("virtual environment", check_environment), ("man", check_manual), ("completion", check_completion), ("faba init", check_examples),
                       ("faba doctor", check_doctor), ("hostile environments", check_hostile)):
        c.check(what, lambda: test(c))
    if o.camera:
        c.check("camera module", lambda: check_camera(c))
    c.check("removal", lambda: check_removal(c, before))
    print(f"{c.failed} failed, {c.skipped} skipped")
    if not c.failed:
        shutil.rmtree(root.folder, ignore_errors=True)
    return 1 if c.failed else 77 if c.skipped else 0


if __name__ == "__main__":
    sys.exit(main())
