#!/bin/sh
# Uses the window as a person does: window.sh VGLARE FOLDER, with lamp.exr and bad.exr in the folder.
# Fails where the program does not end well, says anything, or shows the same before and after a change.
set -eu
vglare=$1 folder=$2

fail() {
    echo "window.sh: $*" >&2
    exit 1
}

for tool in Xvfb xdotool; do
    command -v "$tool" >/dev/null || fail "$tool is missing; on Debian: apt-get install xvfb xdotool"
done

# The server picks a free display itself, and tells of it.
Xvfb -displayfd 3 -screen 0 1280x800x24 -fbdir "$folder" -nolisten tcp 3>"$folder/display" 2>"$folder/xvfb" &
server=$!
window=
trap 'kill $window $server 2>/dev/null || true' EXIT
waited=0
until [ -s "$folder/display" ]; do
    waited=$((waited + 1))
    [ "$waited" -lt 600 ] || fail "Xvfb does not start: $(cat "$folder/xvfb")"
    sleep 0.1
done
DISPLAY=:$(cat "$folder/display")
export DISPLAY
unset WAYLAND_DISPLAY WAYLAND_SOCKET

# What is on the screen, as a number.
shown() {
    cksum <"$folder/Xvfb_screen0"
}

# Waits until the screen is other than $1.
changes() {
    waited=0
    while [ "$(shown)" = "$1" ]; do
        waited=$((waited + 1))
        [ "$waited" -lt 900 ] || fail "nothing changes on the screen after: $2"
        sleep 0.1
    done
    rests
}

# Waits until the screen stays the same for half a second.
rests() {
    waited=0 same=0 before=
    while [ "$same" -lt 5 ]; do
        now=$(shown)
        if [ "$now" = "$before" ]; then same=$((same + 1)); else same=0; fi
        before=$now
        waited=$((waited + 1))
        [ "$waited" -lt 900 ] || fail "the screen never rests"
        sleep 0.1
    done
}

blank=$(shown)
"$vglare" view "$folder/lamp.exr" "$folder/bad.exr" 2>"$folder/told" &
window=$!
changes "$blank" "opening the window"
id=$(xdotool search --onlyvisible --pid "$window" | tail -n 1)
[ -n "$id" ] || fail "there is no window: $(cat "$folder/told")"
xdotool windowfocus "$id"
xdotool windowsize "$id" 1200 760
rests
case $(xdotool getwindowname "$id") in
*lamp.exr*) ;;
*) fail "the title is $(xdotool getwindowname "$id")" ;;
esac

# The photo alone and back, the glare alone and back.
for key in b b g g; do
    before=$(shown)
    xdotool key --window "$id" "$key"
    changes "$before" "the key $key"
done
before=$(shown)
xdotool mousemove 500 300 click 4 click 4
changes "$before" "the wheel"
before=$(shown)
xdotool mousemove 500 300 mousedown 1 sleep 0.3 mousemove 540 340 sleep 0.3 mousemove 600 380 sleep 0.3 mouseup 1
changes "$before" "a drag"

# Nearly nothing, nothing, and back.
xdotool windowsize "$id" 40 30
sleep 0.5
xdotool windowunmap "$id"
sleep 0.5
kill -0 "$window" || fail "it ended while it was hidden: $(cat "$folder/told")"
before=$(shown)
xdotool windowmap "$id"
xdotool windowsize "$id" 1200 760
changes "$before" "coming back"

xdotool windowfocus "$id" key ctrl+q
waited=0
while kill -0 "$window" 2>/dev/null; do
    waited=$((waited + 1))
    [ "$waited" -lt 300 ] || fail "it does not close"
    sleep 0.1
done
status=0
wait "$window" || status=$?
window=
[ "$status" = 0 ] || fail "it ended with $status: $(cat "$folder/told")"
[ ! -s "$folder/told" ] || fail "it said: $(cat "$folder/told")"
