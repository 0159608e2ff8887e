# What the farm tests share: a shot of 24 small frames, and whether all of them arrived. To be sourced; $place is the folder of the test.
set -eu
vglare=${VGLARE:-$(cd "$(dirname "$0")/../.." && pwd)/target/debug/vglare}
[ -x "$vglare" ] || { echo "there is no $vglare: build it, or name another in VGLARE" >&2; exit 1; }
export VGLARE="$vglare" VGLARE_CACHE="$place/cache"

fail() {
    echo "farm: $*" >&2
    exit 1
}

# Frames 1001 to 1024: a lamp that crosses the picture.
make_shot() {
    mkdir -p "$place/in"
    printf 'time, x, y, flux, size\n0, -1.5, -0.4, 20, 0.05\n1, 1.5, 0.4, 20, 0.05\n' >"$place/lamp.csv"
    "$vglare" animate --path "$place/lamp.csv" --frames 24 --frame 192x108 --lens none -q -o "$place/made.####.exr"
    for frame in $(seq 1 24); do
        mv "$place/made.$(printf %04d "$frame").exr" "$place/in/s.$((1000 + frame)).exr"
    done
}

# Whether all frames are there, whole, and what a single run makes of them; and whether none was done twice, as the lines "photo" of all logs
# tell, which are the arguments.
check_shot() {
    (cd "$place" && "$vglare" apply 'in/s.####.exr' -o 'wanted/s.####.exr' -q)
    for frame in $(seq 1001 1024); do
        cmp -s "$place/out/s.$frame.exr" "$place/wanted/s.$frame.exr" || fail "frame $frame is missing, or not what it ought to be"
        [ -s "$place/out/.vglare/s.$frame.exr.json" ] || fail "nothing is known of frame $frame"
    done
    left=$(ls -A "$place/out" | grep -v '^s\.[0-9]*\.exr$' | grep -vx .vglare || true)
    [ -z "$left" ] || fail "something is left: $left"
    twice=$(cat "$@" | grep -o 'photo  *out/s\.[0-9]*\.exr' | sort | uniq -d)
    [ -z "$twice" ] || fail "done twice: $twice"
    done=$(cat "$@" | grep -c 'photo  *out/s\.[0-9]*\.exr')
    [ "$done" -ge 23 ] || fail "the logs tell of $done frames only"
}
