//! Ghosts that no light makes, and the bells of all ghosts, by the panels and over the picture.

use vglare::scene::read_scene;
use vglare::series::Bell;
use vglare::viewer::Told;

use super::*;

impl Session {
    /// A photo on a screen that has room for every panel's controls.
    fn tall() -> Self {
        let mut session = Self::with_photo();
        session.screen = Screen::hidden(&session.device, [SIZE[0], 1600]).unwrap();
        session.settle();
        session
    }

    fn told(&self, name: &str) -> Told {
        let told = self.app.controls().into_iter().find(|told| told.name == name);
        told.unwrap_or_else(|| panic!("{name} is not shown"))
    }

    fn click(&mut self, name: &str) {
        self.click_at(self.told(name).part.center());
    }

    /// Opens a row's list of bells, which the parameters of its bell follow.
    fn open_bells(&mut self, row: u32) {
        self.click_at(self.told(&format!("bell {row}")).part.left_center() + vec2(12.0, 0.0));
    }

    fn click_at(&mut self, at: Pos2) {
        self.time += 1.0;
        self.frame(vec![Event::PointerMoved(at)]);
        self.frame(vec![self.button(at, true)]);
        self.frame(vec![self.button(at, false)]);
        self.settle();
    }
}

#[test]
fn a_ghost_is_placed_dragged_undone_and_saved() {
    let mut session = Session::tall();
    session.click("Add a ghost");
    assert_eq!(session.document().look.ghosts.len(), 1);
    let dark = session.at(DVec2::new(0.5, -0.4));
    let was = session.brightness(dark);
    session.drag(session.at(DVec2::ZERO), dark - session.at(DVec2::ZERO));
    let center = session.document().look.ghosts[0].center;
    assert!((center - DVec2::new(0.5, -0.4)).length() < 0.02, "{center}");
    assert!(session.brightness(dark) > was, "{} after {was}", session.brightness(dark));
    // It stays selected: the keys go to it, and not to the light.
    let lights = session.document().lights().to_vec();
    session.press(Key::ArrowLeft);
    let pixel = session.document().frame.pixel_size();
    assert!((session.document().look.ghosts[0].center.x - (center.x - pixel)).abs() < 1e-9);
    assert_eq!(session.document().lights(), lights);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("look.toml");
    session.app.save_look(&path);
    assert_eq!(session.app.notices(), [] as [String; 0]);
    assert_eq!(read_scene(&path).unwrap().ghosts, *session.document().look.ghosts);

    session.press(Key::Delete);
    assert!(session.document().look.ghosts.is_empty());
    session.shortcut(CTRL, Key::Z);
    assert_eq!(session.document().look.ghosts.len(), 1);
    for _ in 0..3 {
        session.shortcut(CTRL, Key::Z);
    }
    assert_eq!((&session.document().look, session.document().steps()), (&lit(), [false, true]));
}

#[test]
fn bells_are_chosen_from_a_list_and_saved_with_their_parameters() {
    let mut session = Session::tall();
    session.click("Add a ghost");
    session.click("Bell");
    session.click("choose parabola");
    assert_eq!(session.document().look.ghosts[0].bell, Bell::Parabola);
    session.click("Bell");
    session.click("choose von-mises");
    session.click("Lens ghosts");
    session.open_bells(2);
    session.click("choose sine-gaussian");
    session.open_bells(1);
    session.click("choose cosine-squared");
    session.open_bells(3);
    session.click("choose disc");
    let look = session.document().look.clone();
    let bells: Vec<_> = look.lens.ghosts().iter().map(|ghost| ghost.bell.to_string()).collect();
    assert_eq!(bells[..3], ["cosine-squared", "sine-gaussian", "disc"]);
    let period = look.accuracy.period.unwrap();
    assert_eq!((look.ghosts[0].bell.shape().period(), look.bell_period()), (Some(period), period));
    assert_eq!(session.app.problem(), None);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("look.toml");
    session.app.save_look(&path);
    assert_eq!(session.app.notices(), [] as [String; 0]);
    assert_eq!(Look::from_scene(read_scene(&path).unwrap()).unwrap(), look);
}

#[test]
fn a_row_of_the_lens_goes_back_to_what_the_lens_had() {
    let mut session = Session::tall();
    session.app.document_mut().unwrap().look.lens = vglare::look::LookLens::preset("zoom").unwrap();
    session.click("Lens ghosts");
    let before = session.document().look.lens.ghosts().to_vec();
    let mut row = before[1].clone();
    (row.along, row.share, row.tint) = (0.77, 0.5, [0.1, 0.2, 0.3]);
    session.app.document_mut().unwrap().look.set_lens_ghost(1, row);
    session.settle();
    let number = session.told("row 2").label.center();
    session.time += 1.0;
    session.frame(vec![Event::PointerMoved(number)]);
    for _ in 0..2 {
        session.frame(vec![session.button(number, true)]);
        session.frame(vec![session.button(number, false)]);
    }
    session.settle();
    assert_eq!(session.document().look.lens.ghosts(), before);
}

#[test]
fn the_theme_is_remembered() {
    let folder = tempfile::tempdir().unwrap();
    let state = vglare::viewer::model::State::in_folder(folder.path().join("state"));
    let mut session = Session::tall();
    session.app.remember(state.clone());
    let dark = session.brightness(pos2(850.0, 1590.0));
    session.click("choose light");
    assert!(session.brightness(pos2(850.0, 1590.0)) > dark + 300);
    // A thread has one device at a time.
    drop(session);
    let mut other = Session::tall();
    assert_eq!(other.brightness(pos2(850.0, 1590.0)), dark);
    other.app.remember(state);
    other.settle();
    assert!(other.brightness(pos2(850.0, 1590.0)) > dark + 300);
}
