#!/bin/sh
# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

# Install what is missing: Debian's GNAT, gprbuild and Graphviz, and a virtual
# environment in .venv from requirements.lock. Does nothing when all is there.
# With the word "arm" also the compiler for 32-bit Arm, which only figures need;
# with the word "guest" QEMU, the compilers for s390x and 32-bit Arm and, unpacked
# below build/guest and not installed, Debian's kernel, which only `make hw-test` needs.
# With the word "board" the emulator and the compiler for `make board-test`; with the word
# "browser" Chromium, in which the tests use the workbench; with the word "tests" Alire,
# by which the tests build the crates, and asammdf, by which they read MDF.
set -eu
cd "$(dirname "$0")/.."

say() { printf 'setup: %s\n' "$*"; }

packages=
command -v gnatmake >/dev/null 2>&1 || packages="$packages gnat"
command -v gprbuild >/dev/null 2>&1 || packages="$packages gprbuild"
command -v dot >/dev/null 2>&1 || packages="$packages graphviz"
python3 -c 'import ensurepip, venv' 2>/dev/null || packages="$packages python3-venv"
if [ "${1:-}" = arm ]; then
   command -v arm-linux-gnueabihf-gcc-12 >/dev/null 2>&1 ||
      packages="$packages gnat-12-arm-linux-gnueabihf"
fi
if [ "${1:-}" = board ]; then
   command -v qemu-system-aarch64 >/dev/null 2>&1 || packages="$packages qemu-system-arm"
   command -v aarch64-linux-gnu-gnatls >/dev/null 2>&1 ||
      packages="$packages gnat-12-aarch64-linux-gnu"
   command -v aarch64-linux-gnu-gcc >/dev/null 2>&1 || packages="$packages gcc-aarch64-linux-gnu"
fi
if [ "${1:-}" = browser ]; then
   command -v chromium >/dev/null 2>&1 || packages="$packages chromium"
fi
if [ "${1:-}" = guest ]; then
   command -v qemu-system-x86_64 >/dev/null 2>&1 || packages="$packages qemu-system-x86"
   command -v busybox >/dev/null 2>&1 || packages="$packages busybox-static"
   command -v ip >/dev/null 2>&1 || packages="$packages iproute2"
fi

install() {
   as_root=
   if [ "$(id -u)" -ne 0 ]; then
      if ! command -v sudo >/dev/null 2>&1; then
         say "needs the Debian packages $*; as root: apt-get install $*" >&2
         return 1
      fi
      as_root=sudo
   fi
   say "installing the Debian packages $*"
   log=$(mktemp)
   if ! { $as_root apt-get update && DEBIAN_FRONTEND=noninteractive \
          $as_root apt-get install -y --no-install-recommends "$@"; } >"$log" 2>&1
   then
      tail -n 20 "$log" >&2
      say "apt-get failed (above); are the package sources reachable?" >&2
      return 1
   fi
   rm -f "$log"
}

[ -z "$packages" ] || install $packages || exit 2

# Without these only tests are skipped.
others=
if [ "${1:-}" = tests ]; then
   command -v alr >/dev/null 2>&1 || others=alire
fi
if [ "${1:-}" = guest ]; then
   for machine in s390x-linux-gnu arm-linux-gnueabihf; do
      command -v $machine-gnatmake >/dev/null 2>&1 || others="$others gnat-12-$machine"
   done
   command -v qemu-s390x-static >/dev/null 2>&1 || others="$others qemu-user-static"
fi
[ -z "$others" ] || install $others || say "goes on without them"

python3 - <<'EOF' || { say "Python 3.11 or later is needed" >&2; exit 2; }
import sys
sys.exit(sys.version_info < (3, 11))
EOF

stamp=.venv/.installed
wanted=$(cat requirements.lock pyproject.toml | cksum)
if [ ! -f "$stamp" ] || [ "$(cat "$stamp")" != "$wanted" ]; then
   say "making the virtual environment .venv from requirements.lock"
   rm -rf .venv
   python3 -m venv .venv
   if ! .venv/bin/python -m pip install --quiet --disable-pip-version-check \
        --require-hashes -r requirements.lock
   then
      rm -rf .venv
      say "pip failed (above); is the package index reachable?" >&2
      exit 2
   fi
   # The checkout itself goes on the path, nothing of it is copied; with the entry
   # points of pyproject.toml, by which python-can finds the bus backend.
   if ! .venv/bin/python -m pip install --quiet --disable-pip-version-check \
        --no-deps --no-build-isolation --editable .
   then
      rm -rf .venv
      say "pip failed (above) on this checkout" >&2
      exit 2
   fi
   printf '%s' "$wanted" > "$stamp"
fi

# asammdf is in a folder of its own: python-can imports it, and pandas, wherever it finds it.
if [ "${1:-}" = tests ]; then
   stamp=.venv/mdf/.installed
   wanted=$(cksum <requirements-mdf.lock)
   if [ "$(cat "$stamp" 2>/dev/null)" != "$wanted" ]; then
      say "installing asammdf in .venv/mdf from requirements-mdf.lock"
      rm -rf .venv/mdf
      if .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps \
         --require-hashes --target .venv/mdf -r requirements-mdf.lock
      then
         printf '%s' "$wanted" > "$stamp"
      else
         rm -rf .venv/mdf
         say "pip failed (above); goes on without asammdf"
      fi
   fi
fi

# -P: a file yaml.py in the working folder is not imported. SIGINT waits until Python can
# take it in order: env blocks it, and ravenchart/start.py lets it through.
launcher=.venv/bin/ravenchart
text='#!/bin/sh
exec env --block-signal=INT "'"$(pwd)"'/.venv/bin/python" -P -m ravenchart.start "$@"'
if [ "$(cat $launcher 2>/dev/null)" != "$text" ]; then
   rm -f $launcher
   printf '%s\n' "$text" > $launcher
   chmod +x $launcher
fi

# The compiled part of the analysis; nothing happens when it is up to date.
if ! gprbuild -p -q -P analysis/kernel/kernel.gpr; then
   say "analysis/kernel cannot be compiled (above)" >&2
   exit 2
fi

if [ "${1:-}" = guest ] && [ -z "$(ls build/guest/boot/vmlinuz-* 2>/dev/null)" ]; then
   kernel=$(apt-cache depends linux-image-amd64 2>/dev/null |
      sed -n 's/^ *Depends: \(linux-image-[0-9].*\)$/\1/p' | head -n 1)
   if [ -z "$kernel" ]; then
      say "no package source has linux-image-amd64" >&2
      exit 2
   fi
   say "unpacking $kernel below build/guest"
   rm -rf build/guest
   mkdir -p build/guest
   if ! (cd build/guest &&
         apt-get -qq -o APT::Sandbox::User=root download "$kernel" && dpkg-deb -x ./*.deb .)
   then
      rm -rf build/guest
      say "there is no kernel (above); are the package sources reachable?" >&2
      exit 2
   fi
   rm build/guest/*.deb
fi
