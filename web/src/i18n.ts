// Texts of the page in English and Brazilian Portuguese. The descriptions of parameters and the detailed messages of the
// program are in English; kProgram has translations of its short fixed texts.

const en = {
  'app.title': 'Faba live lab',
  'tab.bench': 'Bench', 'bench.title': 'Camera of the bench', 'bench.help': 'The coils are off on this page. Start a run on the bench with faba rig run SCENE --arm.',
  'bench.scene': 'Scene with a bench', 'bench.open': 'Open the camera', 'bench.close': 'Close the camera', 'bench.picture': 'Camera picture', 'bench.waiting': 'Waiting for the first frame.',
  'bench.frames': '{n} frames, {dropped} dropped, {corrupt} corrupt', 'bench.grey': 'mean grey level {mean} of 255', 'bench.white': '{percent} % saturated', 'bench.camera': 'Camera', 'bench.nothing': 'This camera has no controls.', 'bench.units': 'The values are in the units of the camera.',
  'bench.exposure': 'Exposure', 'bench.gain': 'Gain', 'bench.white_balance': 'White balance', 'bench.automatic': 'automatic', 'bench.scale': 'Scale',
  'bench.scale.help': 'Put a ruler under the microscope and measure it once for each objective.', 'bench.objective': 'Objective', 'bench.tick': 'Distance between marks', 'bench.measure': 'Measure the ruler',
  'bench.interval': '(95 %: {low} to {high})', 'bench.kept': '{n} marks found; saved as {file}.', 'bench.poor': '{n} marks found, too few or too uneven; not saved.', 'bench.marks': 'Detected marks',
  'tab.lab': 'Lab', 'tab.gallery': 'Gallery', 'tab.runs': 'Runs', 'tab.analyse': 'Analyse',
  'lost': 'Connection lost: the controls are disabled. The page reconnects automatically. If it does not, check that faba lab still runs in its terminal, or start it again and open the URL that it prints.', 'refused': 'The access token of this page is not valid any more. Open the URL printed by faba lab.', 'again': 'Retry now',
  'no_answer': 'The server does not answer. Start faba lab again and open the URL that it prints.', 'timeout': 'The server did not answer in time. Check that faba lab still runs, and try again.',
  'steer.other': 'Another page controls the swarm.', 'steer.take': 'Take control', 'pages': '{n} pages connected',
  'hint.1': 'Drag on the picture: the swarm swims in the direction of the drag.',
  'hint.2': 'Click to set a setpoint for the controller. Hold Shift and click to set the points of a route.',
  'hint.3': 'All other settings are in the panel; some require a restart. Space pauses.',
  'hint.close': 'Close',
  'run.pause': 'Pause', 'run.go': 'Resume', 'run.step': 'Next frame', 'run.restart': 'Restart', 'run.speed': 'Speed', 'run.real': 'actual {x}×',
  'run.reverse': 'Reverse field', 'run.save': 'Record', 'run.name': 'Recording name', 'run.none': 'No simulation is running. Choose a scene in the gallery.', 'run.stopped': 'The run has ended',
  'run.saved': 'The recording is being written to runs/{name}; the panel Jobs shows the progress.', 'run.renamed': 'The name {taken} is already used: the recording is being written to runs/{name}.',
  'run.characters': '(Characters that are not permitted in names were removed or replaced by a dash.)',
  'steer': 'Steer', 'steer.hand': 'Manual field', 'steer.goal': 'Setpoint', 'steer.route': 'Route', 'steer.strength': 'Field strength', 'steer.stop': 'Zero field',
  'steer.hand.help': 'Drag on the picture, or use the arrow keys or a gamepad.', 'steer.goal.help': 'Click on the picture.', 'steer.goal.set': 'Set',
  'steer.route.help': 'Hold Shift and click the points of the route in order, then press Follow route. Drag a point to move it.', 'steer.route.send': 'Follow route', 'steer.route.clear': 'Clear',
  'steer.outside': 'The setpoint ({x}, {y}) px is outside the camera view, which is {width} × {height} px with (0, 0) at the upper left: the camera does not see the swarm there. Choose a point inside the dashed frame.',
  'steer.unreachable': 'The setpoint ({x}, {y}) px is outside the arena: the swarm swims to the wall and cannot reach it. Choose a point inside the edge.',
  'scenario': 'Scenario', 'scenario.restart': 'Restart with these settings', 'scenario.live': 'Apply', 'scenario.save': 'Export', 'scenario.load': 'Import', 'scenario.copy': 'Copy command', 'scenario.copied': 'Copied',
  'scenario.undo': 'Undo', 'scenario.advanced': 'All settings', 'seed.new': 'Another seed', 'seed.now': 'seed {n}', 'scenario.needs_restart': 'takes effect after a restart', 'scenario.changed_now': 'changed', 'scenario.show_error': 'Show the value',
  'scenario.names': 'The names of the values are the keys of a scenario file.',
  'read.swarm': 'Swarm', 'read.spread': 'dispersion', 'read.goal': 'distance to setpoint', 'read.responding': 'responsive', 'read.currents': 'coils', 'read.coil': 'Coil',
  'run.as_seen': 'as the camera sees it (for analysis)', 'gallery.cancel': 'Cancel', 'scenario.from_first': 'The exported scenario applies all changes from the first frame; to keep their times, use Record.', 'scenario.needs_file': 'Press Export first and save {file}.', 'form.range': 'from {low} to {high}', 'analyse.current': 'Currents, A', 'analyse.current_wrong': 'must be numbers in A, separated by commas, one per coil, such as {example}', 'analyse.current_count': 'must be as many numbers as the file has coils: {n}, such as {example}', 'analyse.current_each': 'one number per coil', 'analyse.current_default': 'empty: the currents of the file', 'analyse.direction_wrong': 'must be a number from -360 to 360 degrees, such as 90; leave it empty to measure the direction',
  'layers': 'Layers', 'layer.trails': 'Trails', 'layer.density': 'Density', 'layer.field': 'Field', 'layer.edge': 'Edge', 'layer.swarm': 'Swarm', 'layer.route': 'Setpoints', 'layer.camera': 'Camera picture', 'view.fit': 'Fit to view',
  'plots': 'Plots', 'plot.distance': 'Distance to the setpoint', 'plot.dispersion': 'Dispersion', 'plot.field': 'Field (y up)', 'plot.responding': 'Responsive cells', 'plot.speed': 'Speed of the swarm', 'plot.activity': 'Mean speed of the cells', 'plot.earlier': 'recorded', 'plot.time': 'time (s)',
  'gallery.title': 'Scenes', 'gallery.start': 'Start', 'gallery.drop': 'Drag a picture or video of a drop here, or choose a file', 'gallery.looking': 'Detecting the edge …', 'gallery.edge': 'Edge of the drop',
  'gallery.edge.help': 'Drag the circle to move it, or its rim to change the radius; then press Start.', 'gallery.cells': '{n} cells', 'gallery.no_drop': 'No arena with a circular edge is available.',
  'gallery.needs_control': 'Start is disabled because this page does not control the swarm; press Take control at the top of the page.', 'gallery.needs_centre': 'Start is disabled because x and y must be numbers.', 'gallery.needs_radius': 'Start is disabled because the radius r must be at least {least} px.', 'gallery.needs_scale': 'Start is disabled because the scale must be above 0 µm/px, or empty.', 'gallery.no_scale': 'Without a scale, lengths are stated in px only, and the cells are simulated at a nominal scale.',
  'runs.title': 'Recorded runs', 'runs.none': 'No recorded runs. Press Record during a run.', 'runs.report': 'Report', 'runs.replay': 'Replay', 'runs.video': 'Video', 'runs.again': 'Use this scenario', 'runs.pin': 'Compare', 'runs.broken': 'incomplete',
  'jobs': 'Jobs', 'jobs.none': 'No jobs.', 'jobs.cancel': 'Cancel', 'job.waiting': 'queued', 'job.running': 'running', 'job.done': 'done', 'job.failed': 'failed', 'job.cancelled': 'cancelled', 'job.left': '{t} left', 'job.open': 'Open', 'job.close': 'Close', 'job.tab': 'Open in a new tab',
  'analyse.title': 'Analyse', 'analyse.activity': 'Activity of a video', 'analyse.compare': 'Compare two videos', 'analyse.identify': 'Identify a model, compare controllers', 'analyse.field': 'Field map', 'analyse.start': 'Start', 'analyse.direction': 'Swimming direction, degrees (0 right, 90 down); empty: measured', 'analyse.video': 'Video or run', 'analyse.reference': 'Reference', 'analyse.study': 'Study', 'analyse.rig': 'Coil system',
  'form.number': 'must be a number', 'form.unit': 'has the wrong unit; it needs a unit such as {unit}', 'form.integer': 'must be an integer', 'form.least': 'must be at least {limit}', 'form.most': 'must be at most {limit}', 'form.source': 'source: {source}', 'form.reset': 'Reset to default', 'form.add': 'Add', 'form.remove': 'Remove', 'form.none': 'not set', 'form.pair': 'needs two numbers, x and y, on each line', 'form.type': 'type', 'form.preset': 'preset', 'form.no_preset': 'custom', 'form.default_preset': 'default',
  'form.default_source': 'source of the default {value}: {source}', 'form.angle': 'Angles in a scenario count counter-clockwise, y up: 0 deg is right, 90 deg is up.',
  'view.label': 'Simulated microscope view of the swarm', 'view.max': 'max',
  'language': 'Language', 'theme': 'Light or dark theme',
} as const;

export type Word = keyof typeof en;

const pt: Record<Word, string> = {
  'app.title': 'Faba, laboratório ao vivo',
  'tab.bench': 'Bancada', 'bench.title': 'Câmera da bancada', 'bench.help': 'As bobinas estão desligadas nesta página. Inicie uma execução na bancada com faba rig run CENA --arm.',
  'bench.scene': 'Cena com bancada', 'bench.open': 'Abrir a câmera', 'bench.close': 'Fechar a câmera', 'bench.picture': 'Imagem da câmera', 'bench.waiting': 'Aguardando o primeiro quadro.',
  'bench.frames': '{n} quadros, {dropped} perdidos, {corrupt} corrompidos', 'bench.grey': 'nível de cinza médio {mean} de 255', 'bench.white': '{percent} % saturado', 'bench.camera': 'Câmera', 'bench.nothing': 'Esta câmera não tem controles.', 'bench.units': 'Os valores estão nas unidades da câmera.',
  'bench.exposure': 'Exposição', 'bench.gain': 'Ganho', 'bench.white_balance': 'Balanço de branco', 'bench.automatic': 'automático', 'bench.scale': 'Escala',
  'bench.scale.help': 'Coloque uma régua sob o microscópio e meça-a uma vez para cada objetiva.', 'bench.objective': 'Objetiva', 'bench.tick': 'Distância entre as marcas', 'bench.measure': 'Medir a régua',
  'bench.interval': '(95 %: {low} a {high})', 'bench.kept': '{n} marcas encontradas; salvo em {file}.', 'bench.poor': '{n} marcas encontradas, poucas ou irregulares; não salvo.', 'bench.marks': 'Marcas detectadas',
  'tab.lab': 'Laboratório', 'tab.gallery': 'Galeria', 'tab.runs': 'Gravações', 'tab.analyse': 'Análise',
  'lost': 'Conexão perdida: os controles estão desativados. A página se reconecta automaticamente. Se isso não ocorrer, verifique se faba lab ainda está em execução no terminal, ou inicie-o novamente e abra o endereço mostrado.', 'refused': 'O token de acesso desta página não é mais válido. Abra o endereço mostrado por faba lab.', 'again': 'Tentar agora',
  'no_answer': 'O servidor não responde. Inicie faba lab novamente e abra o endereço mostrado.', 'timeout': 'O servidor não respondeu a tempo. Verifique se faba lab ainda está em execução e tente novamente.',
  'steer.other': 'Outra página controla o enxame.', 'steer.take': 'Assumir o controle', 'pages': '{n} páginas conectadas',
  'hint.1': 'Arraste sobre a imagem: o enxame nada na direção do movimento do mouse.',
  'hint.2': 'Clique para definir o ponto de referência do controlador. Segure Shift e clique para definir os pontos de uma rota.',
  'hint.3': 'Todos os outros ajustes estão no painel; alguns exigem reiniciar. Espaço pausa.',
  'hint.close': 'Fechar',
  'run.pause': 'Pausar', 'run.go': 'Continuar', 'run.step': 'Próximo quadro', 'run.restart': 'Reiniciar', 'run.speed': 'Velocidade', 'run.real': 'efetiva {x}×',
  'run.reverse': 'Inverter campo', 'run.save': 'Gravar', 'run.name': 'Nome da gravação', 'run.none': 'Nenhuma simulação em execução. Escolha uma cena na galeria.', 'run.stopped': 'A execução terminou',
  'run.saved': 'A gravação está sendo escrita em runs/{name}; o painel Tarefas mostra o progresso.', 'run.renamed': 'O nome {taken} já existe: a gravação está sendo escrita em runs/{name}.',
  'run.characters': '(Caracteres não permitidos em nomes foram removidos ou substituídos por um hífen.)',
  'steer': 'Controle', 'steer.hand': 'Campo manual', 'steer.goal': 'Ponto de referência', 'steer.route': 'Rota', 'steer.strength': 'Intensidade do campo', 'steer.stop': 'Campo nulo',
  'steer.hand.help': 'Arraste sobre a imagem, ou use as setas do teclado ou um gamepad.', 'steer.goal.help': 'Clique na imagem.', 'steer.goal.set': 'Definir',
  'steer.route.help': 'Segure Shift e clique nos pontos da rota em ordem, depois clique em Seguir rota. Arraste um ponto para movê-lo.', 'steer.route.send': 'Seguir rota', 'steer.route.clear': 'Limpar',
  'steer.outside': 'O ponto de referência ({x}, {y}) px está fora da vista da câmera, de {width} × {height} px com (0, 0) no canto superior esquerdo: a câmera não vê o enxame ali. Escolha um ponto dentro da moldura tracejada.',
  'steer.unreachable': 'O ponto de referência ({x}, {y}) px está fora da arena: o enxame nada até a parede e não pode alcançá-lo. Escolha um ponto dentro da borda.',
  'scenario': 'Cenário', 'scenario.restart': 'Reiniciar com estes ajustes', 'scenario.live': 'Aplicar', 'scenario.save': 'Exportar', 'scenario.load': 'Importar', 'scenario.copy': 'Copiar comando', 'scenario.copied': 'Copiado',
  'scenario.undo': 'Desfazer', 'scenario.advanced': 'Todos os ajustes', 'seed.new': 'Outra semente', 'seed.now': 'semente {n}', 'scenario.needs_restart': 'vale após reiniciar', 'scenario.changed_now': 'alterado', 'scenario.show_error': 'Mostrar o valor',
  'scenario.names': 'Os nomes dos valores são as chaves de um arquivo de cenário; as descrições estão em inglês.',
  'read.swarm': 'Enxame', 'read.spread': 'dispersão', 'read.goal': 'distância ao ponto de referência', 'read.responding': 'responsivas', 'read.currents': 'bobinas', 'read.coil': 'Bobina',
  'run.as_seen': 'como a câmera vê (para análise)', 'gallery.cancel': 'Cancelar', 'scenario.from_first': 'O cenário exportado aplica todas as alterações desde o primeiro quadro; para manter os seus tempos, use Gravar.', 'scenario.needs_file': 'Clique antes em Exportar e salve {file}.', 'form.range': 'de {low} a {high}', 'analyse.current': 'Correntes, A', 'analyse.current_wrong': 'devem ser números em A, separados por vírgulas, um por bobina, como {example}', 'analyse.current_count': 'devem ser tantos números quantas bobinas o arquivo tem: {n}, como {example}', 'analyse.current_each': 'um número por bobina', 'analyse.current_default': 'vazio: as correntes do arquivo', 'analyse.direction_wrong': 'deve ser um número de -360 a 360 graus, como 90; deixe vazio para medir a direção',
  'layers': 'Camadas', 'layer.trails': 'Rastros', 'layer.density': 'Densidade', 'layer.field': 'Campo', 'layer.edge': 'Borda', 'layer.swarm': 'Enxame', 'layer.route': 'Pontos de referência', 'layer.camera': 'Imagem da câmera', 'view.fit': 'Ajustar à vista',
  'plots': 'Gráficos', 'plot.distance': 'Distância ao ponto de referência', 'plot.dispersion': 'Dispersão', 'plot.field': 'Campo (y para cima)', 'plot.responding': 'Células responsivas', 'plot.speed': 'Velocidade do enxame', 'plot.activity': 'Velocidade média das células', 'plot.earlier': 'gravada', 'plot.time': 'tempo (s)',
  'gallery.title': 'Cenas', 'gallery.start': 'Iniciar', 'gallery.drop': 'Arraste para cá uma imagem ou um vídeo de uma gota, ou escolha um arquivo', 'gallery.looking': 'Detectando a borda …', 'gallery.edge': 'Borda da gota',
  'gallery.edge.help': 'Arraste o círculo para movê-lo, ou a borda para mudar o raio; depois clique em Iniciar.', 'gallery.cells': '{n} células', 'gallery.no_drop': 'Não há arena com borda circular.',
  'gallery.needs_control': 'Iniciar está desativado porque esta página não controla o enxame; clique em Assumir o controle no alto da página.', 'gallery.needs_centre': 'Iniciar está desativado porque x e y devem ser números.', 'gallery.needs_radius': 'Iniciar está desativado porque o raio r deve ser no mínimo {least} px.', 'gallery.needs_scale': 'Iniciar está desativado porque a escala deve ser maior que 0 µm/px, ou vazia.', 'gallery.no_scale': 'Sem escala, os comprimentos são dados somente em px, e as células são simuladas com uma escala nominal.',
  'runs.title': 'Gravações', 'runs.none': 'Nenhuma gravação. Clique em Gravar durante uma execução.', 'runs.report': 'Relatório', 'runs.replay': 'Reproduzir', 'runs.video': 'Vídeo', 'runs.again': 'Usar este cenário', 'runs.pin': 'Comparar', 'runs.broken': 'incompleta',
  'jobs': 'Tarefas', 'jobs.none': 'Nenhuma tarefa.', 'jobs.cancel': 'Cancelar', 'job.waiting': 'na fila', 'job.running': 'em execução', 'job.done': 'concluída', 'job.failed': 'falhou', 'job.cancelled': 'cancelada', 'job.left': 'faltam {t}', 'job.open': 'Abrir', 'job.close': 'Fechar', 'job.tab': 'Abrir em nova aba',
  'analyse.title': 'Análise', 'analyse.activity': 'Atividade de um vídeo', 'analyse.compare': 'Comparar dois vídeos', 'analyse.identify': 'Identificar um modelo, comparar controladores', 'analyse.field': 'Mapa do campo', 'analyse.start': 'Iniciar', 'analyse.direction': 'Direção do nado, graus (0 direita, 90 para baixo); vazio: medida', 'analyse.video': 'Vídeo ou gravação', 'analyse.reference': 'Referência', 'analyse.study': 'Estudo', 'analyse.rig': 'Sistema de bobinas',
  'form.number': 'deve ser um número', 'form.unit': 'tem a unidade errada; precisa de uma unidade como {unit}', 'form.integer': 'deve ser um número inteiro', 'form.least': 'deve ser no mínimo {limit}', 'form.most': 'deve ser no máximo {limit}', 'form.source': 'fonte: {source}', 'form.reset': 'Restaurar o padrão', 'form.add': 'Adicionar', 'form.remove': 'Remover', 'form.none': 'não definido', 'form.pair': 'precisa de dois números, x e y, em cada linha', 'form.type': 'tipo', 'form.preset': 'predefinição', 'form.no_preset': 'personalizado', 'form.default_preset': 'padrão',
  'form.default_source': 'fonte do padrão {value}: {source}', 'form.angle': 'Os ângulos de um cenário contam no sentido anti-horário, y para cima: 0 deg é à direita, 90 deg é para cima.',
  'view.label': 'Vista simulada do enxame no microscópio', 'view.max': 'máx.',
  'language': 'Idioma', 'theme': 'Tema claro ou escuro',
};

export type Language = 'en' | 'pt';
export const kWords: Record<Language, Record<Word, string>> = { en, pt };

/** Translations of fixed texts of the program: sections of a scenario, verbs, steps of a job, messages of the server. */
export const kProgram: Record<Language, Record<string, string>> = {
  en: {},
  pt: {
    swarm: 'enxame', model: 'modelo', start: 'posições iniciais', controller: 'controlador', reference: 'referência', estimator: 'estimador', field: 'campo', motility: 'motilidade', scale: 'escala', camera: 'câmera',
    limits: 'limites', exclusion: 'exclusão', simulation: 'simulação', record: 'gravação', microscope: 'microscópio', flow: 'fluxo óptico', rig: 'bancada', library: 'biblioteca', coil: 'bobina', segment: 'segmento',
    activity: 'atividade', compare: 'comparação', identify: 'identificação', 'compare-controllers': 'comparação de controladores', 'field map': 'mapa do campo',
    simulating: 'simulando', 'simulating with another seed': 'simulando com outra semente', measuring: 'medindo', tracking: 'rastreando', trials: 'ensaios', capturing: 'capturando', replaying: 'reproduzindo',
    'another page is steering; take control first': 'outra página controla o enxame; assuma antes o controle',
    'no run; start a scenario first': 'nenhuma execução; inicie antes um cenário',
    'no camera is open': 'nenhuma câmera está aberta',
    'no image from the camera': 'não há imagem da câmera',
    'camera: no more pictures; this is the last one': 'câmera: não há mais imagens; esta é a última',
    'a value has the wrong type': 'um valor tem o tipo errado',
    'file not found': 'arquivo não encontrado',
    'file not found in the folder in which the lab was started': 'arquivo não encontrado na pasta em que o laboratório foi iniciado',
    'is outside the folder in which the lab was started': 'está fora da pasta em que o laboratório foi iniciado',
    'scene not found': 'cena não encontrada',
    'not found': 'não encontrado',
    'job not found': 'tarefa não encontrada',
    'missing; it must be a non-empty string': 'falta; deve ser um texto não vazio',
    'the run has no tracks.h5; only its video can be displayed': 'a gravação não tem tracks.h5; só o vídeo pode ser mostrado',
  },
};

export function words(language: Language) {
  const say = (key: Word, values: Record<string, string | number> = {}) =>
    kWords[language][key].replace(/\{(\w+)\}/g, (all, name) => (name in values ? String(values[name]) : all));
  return Object.assign(say, { language });
}
export type Say = ReturnType<typeof words>;
