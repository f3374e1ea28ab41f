#!/bin/busybox sh
# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

# The first process of the guest of `make hw-test`: modules, the machine's own
# root, read-only, the folder of results, CAN interfaces, and then the steps.
/bin/busybox --install -s /bin
export PATH=/bin:/sbin:/usr/bin:/usr/sbin:/usr/local/bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs dev /dev
. /told    # CHECKOUT and RESULTS, paths of the machine
while read -r module; do insmod "/modules/$module"; done </modules/order

options=trans=virtio,version=9p2000.L,msize=512000
mount -t 9p -o "ro,cache=loose,$options" machine /machine
for place in proc sys dev; do mount -o bind "/$place" "/machine/$place"; done
mount -t 9p -o "$options" results "/machine$RESULTS"
mkdir -p /dev/shm

chroot /machine /bin/sh -c "
   ip link add vcan0 mtu 72 type vcan
   ip link set vcan0 up
   ip link set can0 up type can bitrate 500000
   ip link set can1 up type can bitrate 500000"

# CTU CAN FD (vendor 1760 of QEMU): no driver, so nothing has enabled it yet.
for card in /sys/bus/pci/devices/*; do
   [ "$(cat "$card/vendor")" = 0x1760 ] && echo 1 >"$card/enable"
done

export TMPDIR=/dev/shm HOME=/dev/shm PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$CHECKOUT"
chroot /machine /bin/sh -c "cd $RESULTS && . ./steps"
sync
reboot -f
