"""The page for playing the contact: a server, a session for each open page, and the files of the page."""
