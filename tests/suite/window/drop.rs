//! Files dropped onto a window by the XDND protocol, version 5, which xdotool does not speak.

use std::error::Error;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
    SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT, CURRENT_TIME};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The side that lets go of a file.
struct Source {
    server: RustConnection,
    target: Window,
    /// What it says of the file when asked.
    uri: String,
}

/// Drops a file on a window at a pixel of the screen, and waits until it has been taken.
pub fn drop_file(display: &str, target: Window, at: [u16; 2], file: &Path) -> Result<()> {
    let (server, screen) = x11rb::connect(Some(display))?;
    let root = server.setup().roots[screen].root;
    let own = server.generate_id()?;
    let (depth, class) = (COPY_DEPTH_FROM_PARENT, WindowClass::INPUT_OUTPUT);
    server.create_window(depth, own, root, 0, 0, 1, 1, 0, class, COPY_FROM_PARENT, &CreateWindowAux::new())?;
    let source = Source { server, target, uri: format!("file://{}\r\n", file.display()) };
    source.server.set_selection_owner(own, source.atom("XdndSelection")?, CURRENT_TIME)?;

    let (list, copy) = (source.atom("text/uri-list")?, source.atom("XdndActionCopy")?);
    source.tell("XdndEnter", [own, 5 << 24, list, 0, 0])?;
    let place = u32::from(at[0]) << 16 | u32::from(at[1]);
    source.tell("XdndPosition", [own, 0, place, CURRENT_TIME, copy])?;
    let status = source.answer("XdndStatus")?;
    assert!(status[1] & 1 == 1, "the window does not want the file: {status:?}");
    source.tell("XdndDrop", [own, 0, CURRENT_TIME, 0, 0])?;
    source.answer("XdndFinished")?;
    Ok(())
}

impl Source {
    fn atom(&self, name: &str) -> Result<Atom> {
        Ok(self.server.intern_atom(false, name.as_bytes())?.reply()?.atom)
    }

    fn tell(&self, what: &str, data: [u32; 5]) -> Result<()> {
        let message = ClientMessageEvent::new(32, self.target, self.atom(what)?, data);
        self.server.send_event(false, self.target, EventMask::NO_EVENT, message)?;
        Ok(self.server.flush()?)
    }

    /// Waits for a message, and says what the file is when asked meanwhile.
    fn answer(&self, what: &str) -> Result<[u32; 5]> {
        let (expected, started) = (self.atom(what)?, Instant::now());
        while started.elapsed() < Duration::from_secs(60) {
            match self.server.poll_for_event()? {
                Some(Event::ClientMessage(message)) if message.type_ == expected => {
                    return Ok(message.data.as_data32());
                }
                Some(Event::SelectionRequest(request)) => self.give(&request)?,
                Some(_) => {}
                None => sleep(Duration::from_millis(5)),
            }
        }
        Err(format!("no {what} ever comes").into())
    }

    fn give(&self, request: &SelectionRequestEvent) -> Result<()> {
        let &SelectionRequestEvent { requestor, selection, target, property, time, .. } = request;
        let uri = self.uri.as_bytes();
        self.server.change_property8(PropMode::REPLACE, requestor, property, target, uri)?;
        let response_type = SELECTION_NOTIFY_EVENT;
        let told = SelectionNotifyEvent { response_type, sequence: 0, time, requestor, selection, target, property };
        self.server.send_event(false, requestor, EventMask::NO_EVENT, told)?;
        Ok(self.server.flush()?)
    }
}
