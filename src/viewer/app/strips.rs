//! Tabs at the top, and strips at the bottom: what is being read, and what went wrong.

use egui::{Align, Layout, Panel, RichText, Ui};

use super::App;
use crate::printable;

impl App {
    /// One tab for each document, where there are several.
    pub(super) fn tabs(&mut self, ui: &mut Ui) {
        if self.documents.len() < 2 {
            return;
        }
        let mut closed = None;
        Panel::top("tabs").show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (index, (_, document)) in self.documents.iter().enumerate() {
                    let tab = ui.selectable_label(index == self.current, document.name());
                    if tab.on_hover_text(printable::line(&document.path.to_string_lossy())).clicked() {
                        self.current = index;
                    }
                    if ui.small_button("×").on_hover_text("Close it (Ctrl+W)").clicked() {
                        closed = Some(index);
                    }
                }
            });
        });
        if let Some(index) = closed {
            self.close(index);
        }
    }

    /// What is being read, and what went wrong.
    pub(super) fn strips(&mut self, ui: &mut Ui) {
        let reading: Vec<_> = self.loader.under_way().map(|path| printable::line(&path.to_string_lossy())).collect();
        if !reading.is_empty() {
            Panel::bottom("reading").show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(format!("Reading {}", reading.join(", ")));
                    if ui.button("Cancel").clicked() {
                        self.stop_reading();
                    }
                });
            });
        }
        if let Some(problem) = self.stage.problem() {
            Panel::bottom("problem").show(ui, |ui| {
                ui.label(
                    RichText::new(format!("The picture is of a look before: {problem}"))
                        .color(ui.visuals().warn_fg_color),
                );
            });
        }
        let mut dismissed = None;
        for (index, text) in self.notices.iter().enumerate() {
            Panel::bottom(("notice", index)).show(ui, |ui| {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.button("×").on_hover_text("Dismiss").clicked() {
                        dismissed = Some(index);
                    }
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        ui.label(RichText::new(text).color(ui.visuals().error_fg_color));
                    });
                });
            });
        }
        if let Some(index) = dismissed {
            self.notices.remove(index);
        }
    }
}
